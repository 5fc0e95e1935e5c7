"""Align examples in a common time, so that equal phases can be compared and mixed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motion import Motion, forward_kinematics, warp
from ..signals import smooth_gaussian
from .curves import headings_from_motion

ALIGNMENT_RATE_HZ = 20.0
"""Frame rate at which examples are aligned. More than twice 6 Hz, below which nearly all
power of walking is (Winter et al. 1974, Journal of Biomechanics 7, 157)."""
MAX_ALIGNED_FRAMES = 1500
"""Maximum frames of an example for alignment; longer examples are sampled more coarsely. It
bounds the run time of examples of minutes."""
ALIGNMENT_SMOOTHING_S = 0.2
"""Standard deviation in seconds of the Gaussian that smooths the alignment: the steps of a
warping path are no change of speed by the actor. Half and twice are no better
(`make sensitivity`)."""
MAX_RELATIVE_SPEED = 2.5
"""Maximum speed, relative to its own, at which the time of one example passes in that of
another; the minimum is its inverse. Half and twice gain less than 1 % (`make sensitivity`)."""
WARP_WINDOW = 0.3
"""Fraction of the clip by which the time of an example may run ahead of another's. Half and
twice gain less than 1 % (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class AlignedExamples:
    """Examples in common time.

    Attributes
    ----------
    times : shape (n_examples, n_samples), frames
        Frame of each example at each sample of the common time; strictly increasing.
    distances : shape (n_examples, n_examples), meters
        Mean joint distance between each pair of examples after alignment.
    center : int
        The medoid: the example nearest to all others. Its time is the common time.
    """

    times: Array
    distances: Array
    center: int


def positions_in_body_frame(motion: Motion, headings: Array | None = None) -> Array:
    """Return joint positions in the actor's body frame, shape (n_frames, n_joints, 3).

    The origin is below the hips at floor level, and the axes follow the heading. The hips keep
    their height.
    """
    headings = headings_from_motion(motion) if headings is None else headings
    positions = forward_kinematics(motion).positions - motion.root_positions[:, None] * (
        1,
        1,
        0,
    )
    cos, sin = np.cos(headings)[:, None], np.sin(headings)[:, None]
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([cos * x + sin * y, cos * y - sin * x, z], axis=-1)


def align_examples(motions: Sequence[Motion], headings: Sequence[Array]) -> AlignedExamples:
    """Align examples in time with their medoid by dynamic time warping.

    The headings of a motion are angles in radians, (n_frames,).
    """
    steps = [
        max(
            round(motion.frame_rate / ALIGNMENT_RATE_HZ),
            motion.n_frames // MAX_ALIGNED_FRAMES,
            1,
        )
        for motion in motions
    ]
    bodies = [
        positions_in_body_frame(motion, heading)[::step]
        for motion, heading, step in zip(motions, headings, steps, strict=True)
    ]
    n = len(motions)
    paths = {
        (i, j): warp(bodies[i], bodies[j], WARP_WINDOW)
        for i in range(n)
        for j in range(i + 1, n)
    }
    distances = np.zeros((n, n))
    for (i, j), result in paths.items():
        distances[i, j] = distances[j, i] = result.cost
    center = int(distances.sum(axis=0).argmin())
    n_samples = motions[center].n_frames
    times = np.empty((n, n_samples))
    for i, motion in enumerate(motions):
        if i == center:
            times[i] = np.arange(n_samples)
            continue
        path = paths[min(i, center), max(i, center)].path
        center_frames, example_frames = (path.T if center < i else path.T[::-1]) * np.array([
            [steps[center]],
            [steps[i]],
        ])
        times[i] = _smooth_times(
            center_frames,
            example_frames,
            n_samples,
            motion.n_frames,
            motions[center].frame_rate,
        )
    return AlignedExamples(times, distances, center)


def _smooth_times(
    center_frames: Array,
    example_frames: Array,
    n_center: int,
    n_example: int,
    frame_rate: float,
) -> Array:
    """Return the example's frame at each frame of the center, smooth and increasing."""
    frames = np.arange(n_center)
    counts = np.bincount(center_frames, minlength=n_center)
    means = np.bincount(center_frames, example_frames, minlength=n_center) / np.maximum(
        counts, 1
    )
    raw = np.interp(frames, frames[counts > 0], means[counts > 0])
    raw[0], raw[-1] = 0.0, n_example - 1.0
    if n_center < 3:
        return np.linspace(0.0, n_example - 1.0, n_center)
    mean_speed = (n_example - 1.0) / (n_center - 1.0)
    deviations = smooth_gaussian(raw - mean_speed * frames, ALIGNMENT_SMOOTHING_S * frame_rate)
    speeds = np.clip(
        np.diff(deviations) + mean_speed,
        1.0 / MAX_RELATIVE_SPEED * mean_speed,
        MAX_RELATIVE_SPEED * mean_speed,
    )
    times = np.concatenate([[0.0], np.cumsum(speeds)])
    return np.asarray(times * (n_example - 1.0) / times[-1])
