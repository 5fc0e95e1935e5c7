"""Find where the root of a body is put elsewhere from one frame to the next, and stays."""

from typing import NamedTuple

import numpy as np

from ...motion import Motion, Tracks
from ...motion.skeletons import MIN_SHOT_S, shot_ranges

N_NEIGHBORS = 3
"""Steps on each side whose median predicts a step. Chosen by hand: 3 at 30 Hz are 0.1 s, in
which a body hardly changes its speed."""
MIN_JUMP_M = 0.05
"""Smallest jump, meters. Chosen by hand: 5 cm at 120 Hz are 6 m/s."""
MAX_ACCELERATION = 100.0
"""Largest acceleration of a body, m/s^2. Chosen by hand: ten times gravity, as in a landing."""


class PathJump(NamedTuple):
    """The first frame at the new position, and the distance from where the path led, meters."""

    frame: int
    distance: float


def find_path_jumps(recording: Motion | Tracks, cuts: tuple[int, ...]) -> tuple[PathJump, ...]:
    """Return the jumps of the root that do not come back within a quarter of a second.

    Trackers in headsets and models of video put a body elsewhere when they find themselves
    again, in the same pose. No step before or after shows the speed of such a jump. Cuts are
    not counted, nor are tracks, which have no root.
    """
    if isinstance(recording, Tracks):
        return ()
    limit = max(MIN_JUMP_M, MAX_ACCELERATION / recording.frame_rate**2)
    brief = max(round(MIN_SHOT_S * recording.frame_rate), 1)
    jumps = []
    for start, stop in shot_ranges(recording, cuts):
        steps = np.diff(recording.root_positions[start:stop], axis=0)
        if len(steps) <= 2 * N_NEIGHBORS:
            continue
        padded = np.pad(steps, ((N_NEIGHBORS, N_NEIGHBORS), (0, 0)), mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * N_NEIGHBORS + 1, axis=0)
        excess = steps - np.median(np.delete(windows, N_NEIGHBORS, axis=-1), axis=-1)
        sizes = np.linalg.norm(excess, axis=-1)
        for step in np.flatnonzero(sizes > limit):
            around = excess[max(step - brief, 0) : step + brief + 1]
            if np.linalg.norm(around.sum(axis=0)) > 0.5 * sizes[step]:
                jumps.append(PathJump(start + int(step) + 1, float(sizes[step])))
    return tuple(jumps)
