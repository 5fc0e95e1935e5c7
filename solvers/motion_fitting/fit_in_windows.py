"""Fit long takes in overlapping windows, so that memory does not grow with the take."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from ..motion import Motion
from ..progress import Progress, unwatched, within
from ..rotations import slerp

MAX_FRAMES = 4000
"""Frames that are fitted at once. It bounds the memory: about 50 kB for a frame of two legs,
240 kB for one of a body."""
OVERLAP_S = 2.0
"""Seconds in which two windows overlap, and over which one passes into the next. It guards
contacts at the end of a window."""


def fit_in_windows(
    motion: Motion,
    fit_window: Callable[[int, int, Progress], Motion],
    progress: Progress = unwatched,
) -> Motion:
    """Return the motion, fitted window by window.

    `fit_window` gets the first frame of a window, the frame after its last one, and where to
    report progress; it returns the fitted window.
    """
    ranges = window_ranges(motion.n_frames, motion.frame_rate)
    windows = [
        fit_window(
            start, stop, within(progress, number / len(ranges), (number + 1) / len(ranges))
        )
        for number, (start, stop) in enumerate(ranges)
    ]
    return join_windows(windows, ranges)


def window_ranges(n_frames: int, frame_rate: float) -> list[tuple[int, int]]:
    """Return first frames of the windows of a take, and the frames after their last ones."""
    overlap = min(max(2, round(OVERLAP_S * frame_rate)), MAX_FRAMES // 2)
    starts = range(0, max(n_frames - overlap, 1), MAX_FRAMES - overlap)
    return [(start, min(start + MAX_FRAMES, n_frames)) for start in starts]


def join_windows(windows: Sequence[Motion], ranges: Sequence[tuple[int, int]]) -> Motion:
    """Return the take, blended linearly from one window to the next where they overlap."""
    rotations, roots = windows[0].rotations, windows[0].root_positions
    for window, ((_, end), (start, _)) in zip(windows[1:], pairwise(ranges), strict=True):
        fraction = np.linspace(0.0, 1.0, end - start + 2)[1:-1]
        n = end - start
        blended = slerp(rotations[start:], window.rotations[:n], fraction[:, None])
        moved = roots[start:] + fraction[:, None] * (window.root_positions[:n] - roots[start:])
        rotations = np.concatenate([rotations[:start], blended, window.rotations[n:]])
        roots = np.concatenate([roots[:start], moved, window.root_positions[n:]])
    return windows[0].with_poses(rotations, roots)
