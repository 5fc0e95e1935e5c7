"""Find where the root of a body is put elsewhere from one frame to the next, and stays."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...signals import local_median
from .motion import Motion
from .shot_boundaries import shot_ranges
from .tracks import Tracks

N_NEIGHBORS = 3
"""Steps on each side whose median predicts a step. Chosen by hand: 3 at 30 Hz are 0.1 s, in
which a body hardly changes its speed."""
MIN_JUMP_M = 0.05
"""Smallest jump, meters. Chosen by hand: 5 cm at 120 Hz are 6 m/s."""
MAX_ACCELERATION = 100.0
"""Largest acceleration of a body, m/s^2. Chosen by hand: ten times gravity, as in a landing."""
MAX_RETURN_S = 0.3
"""Seconds after which a body that comes back was not put elsewhere by an error. By definition:
Clean returns it if it does so earlier."""
MIN_NOISE_RATIO = 6.0
"""Smallest jump as a ratio to the median deviation of steps from their neighbors, over the take
and within 0.3 seconds. Sweep: without it, and the median position, hands and feet of
development takes with noise and outliers are off by 8.7 cm in place of 3.1."""


class PathJump(NamedTuple):
    """The first frame at the new position, and the offset from where the path led, meters."""

    frame: int
    offset: Array

    @property
    def distance(self) -> float:
        """Length of the offset, meters."""
        return float(np.linalg.norm(self.offset))


def find_path_jumps(recording: Motion | Tracks, cuts: tuple[int, ...]) -> tuple[PathJump, ...]:
    """Return the jumps of the root that do not come back within 0.3 seconds.

    Trackers in headsets and models of video put a body elsewhere when they find themselves
    again, in the same pose. No step before or after shows the speed of such a jump. Cuts are
    not counted, nor are tracks, which have no root. Among noise and outliers a jump is larger
    than the noise, and the median position after it is elsewhere.
    """
    if isinstance(recording, Tracks):
        return ()
    limit = max(MIN_JUMP_M, MAX_ACCELERATION / recording.frame_rate**2)
    brief = max(round(MAX_RETURN_S * recording.frame_rate), 1)
    jumps = []
    for start, stop in shot_ranges(recording, cuts):
        steps = np.diff(recording.root_positions[start:stop], axis=0)
        if len(steps) <= 2 * N_NEIGHBORS:
            continue
        padded = np.pad(steps, ((N_NEIGHBORS, N_NEIGHBORS), (0, 0)), mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * N_NEIGHBORS + 1, axis=0)
        excess = steps - np.median(np.delete(windows, N_NEIGHBORS, axis=-1), axis=-1)
        sizes = np.linalg.norm(excess, axis=-1)
        known = np.nan_to_num(sizes)
        noise = MIN_NOISE_RATIO * np.maximum(local_median(known, brief), np.median(known))
        for step in np.flatnonzero(sizes > np.maximum(limit, noise)):
            around = excess[max(step - brief, 0) : step + brief + 1]
            if np.linalg.norm(around.sum(axis=0)) > 0.5 * sizes[step] and _is_lasting(
                recording.root_positions[start:stop], int(step), excess[step], brief
            ):
                jumps.append(PathJump(start + int(step) + 1, excess[step]))
    return tuple(jumps)


def _is_lasting(path: Array, step: int, jump: Array, brief: int) -> bool:
    """Return whether the median of the path moves on by more than half of the jump.

    That is more than at its median speed, over frames on both sides; outliers do not matter.
    """
    before = path[max(step + 1 - brief, 0) : step + 1]
    after = path[step + 1 : step + 1 + brief]
    steps = np.diff(path[max(step + 1 - brief, 0) : step + 1 + brief], axis=0)
    duration = 0.5 * (len(before) + len(after))
    moved = np.nanmedian(after, axis=0) - np.nanmedian(before, axis=0)
    moved -= duration * np.nanmedian(steps, axis=0)
    return bool(moved @ jump > 0.5 * (jump @ jump))


def path_offsets(jumps: tuple[PathJump, ...], n_frames: int) -> Array:
    """Return how far all jumps so far have put the root elsewhere, shape (n_frames, 3)."""
    offsets = np.zeros((n_frames, 3))
    for jump in jumps:
        offsets[jump.frame :] += jump.offset
    return offsets


def move_root(motion: Motion, offsets: Array) -> Motion:
    """Return the motion with the root moved, shape (n_frames, 3), meters."""
    return motion.with_poses(root_positions=motion.root_positions + offsets)
