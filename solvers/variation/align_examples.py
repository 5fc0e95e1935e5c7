"""Examples in one common time, so that the same moments of all can be compared and mixed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import Motion, forward_kinematics, warp
from .motion_curves import headings_from_motion

Array = NDArray[np.float64]

ALIGNMENT_RATE_HZ = 20.0
"""Hertz at which examples are lined up."""
LONGEST = 1500
"""Steps of an example that are lined up at most; longer ones are seen less often."""
CALM = 0.2
"""Seconds over which the alignment is smoothed: its steps are no haste of the actor's."""
SLOWEST, FASTEST = 0.4, 2.5
"""Speeds between which the time of one example passes in that of another."""
WINDOW = 0.3
"""Part of the clip by which the time of an example may run ahead of another's."""


@dataclass(frozen=True, eq=False)
class Alignment:
    """Examples in common time.

    Attributes
    ----------
    times : shape (n_examples, n_moments), frames
        In which frame each example is at each moment of the common time; they rise.
    distances : shape (n_examples, n_examples), metres
        Mean distance of joints between any two of them after alignment.
    centre : int
        The example whose time the common time is: the one nearest to all others.
    """

    times: Array
    distances: Array
    centre: int


def positions_in_body_frame(motion: Motion, turns: Array | None = None) -> Array:
    """Return joints relative to the hips as the actor faces, shape (n_frames, n_joints, 3).

    The hips themselves are told by their height.
    """
    turns = headings_from_motion(motion) if turns is None else turns
    places = forward_kinematics(motion).positions - motion.root_positions[:, None] * (1, 1, 0)
    cos, sin = np.cos(turns)[:, None], np.sin(turns)[:, None]
    x, y, z = np.moveaxis(places, -1, 0)
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=-1)


def align_examples(motions: Sequence[Motion], turns: Sequence[Array]) -> Alignment:
    """Line examples up in time by dynamic time warping, with the one in the middle of them."""
    steps = [
        max(round(motion.frame_rate / ALIGNMENT_RATE_HZ), motion.n_frames // LONGEST, 1)
        for motion in motions
    ]
    bodies = [
        positions_in_body_frame(motion, turn)[::step]
        for motion, turn, step in zip(motions, turns, steps, strict=True)
    ]
    n = len(motions)
    paths = {
        (i, j): warp(bodies[i], bodies[j], WINDOW) for i in range(n) for j in range(i + 1, n)
    }
    distances = np.zeros((n, n))
    for (i, j), found in paths.items():
        distances[i, j] = distances[j, i] = found.cost
    centre = int(distances.sum(axis=0).argmin())
    n_moments = motions[centre].n_frames
    times = np.empty((n, n_moments))
    for i, motion in enumerate(motions):
        if i == centre:
            times[i] = np.arange(n_moments)
            continue
        path = paths[min(i, centre), max(i, centre)].path
        ours, theirs = (path.T if centre < i else path.T[::-1]) * np.array([
            [steps[centre]],
            [steps[i]],
        ])
        times[i] = _calm(ours, theirs, n_moments, motion.n_frames, motions[centre].frame_rate)
    return Alignment(times, distances, centre)


def _calm(ours: Array, theirs: Array, n_ours: int, n_theirs: int, rate: float) -> Array:
    """Return in which of their frames each of ours is, smoothly rising from first to last."""
    moments = np.arange(n_ours)
    counts = np.bincount(ours, minlength=n_ours)
    told = np.bincount(ours, theirs, minlength=n_ours) / np.maximum(counts, 1)
    raw = np.interp(moments, moments[counts > 0], told[counts > 0])
    raw[0], raw[-1] = 0.0, n_theirs - 1.0
    if n_ours < 3:
        return np.linspace(0.0, n_theirs - 1.0, n_ours)
    even = (n_theirs - 1.0) / (n_ours - 1.0)
    beside = gaussian_filter1d(raw - even * moments, CALM * rate, mode="nearest")
    speeds = np.clip(np.diff(beside) + even, SLOWEST * even, FASTEST * even)
    times = np.concatenate([[0.0], np.cumsum(speeds)])
    return np.asarray(times * (n_theirs - 1.0) / times[-1])
