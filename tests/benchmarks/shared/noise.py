"""Corrupted and scored channels: joint angles of a motion, their noise and their errors.

Channels are, in degrees: the heading of the root; the rotation vector of the root without its
heading; the rotation vector of every other joint; each about the mean rotation of the training
clips. Only channels that move by more than STILL in the training clips are used. Noise on the
root's position is that on the angles times METERS_PER_DEGREE and is scored separately.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from zlib import crc32

import numpy as np
import scipy
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import Motion
from solvers.rotations.representations import (
    angle_between,
    inverse,
    mean_rotation,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)

STILL = 0.3
METERS_PER_DEGREE = 0.005
OUTLIERS = (20.0, 60.0)
"""Degrees; outliers lie this far from the truth, to either side."""
FILTER_HZ = 8.0
BURSTS = (2, 8)
"""Frames, shortest and longest."""


@dataclass(frozen=True, eq=False)
class Channels:
    """How motions of one skeleton become columns of degrees, and back."""

    means: Array
    kept: NDArray[np.bool_]

    @property
    def joints(self) -> NDArray[np.bool_]:
        """Which joints move."""
        moving = self.kept[1:].reshape(-1, 3).any(axis=1)
        moving[0] |= self.kept[0]
        return np.asarray(moving)

    def of_joints(self, joints: Sequence[int]) -> NDArray[np.intp]:
        """Indices of these joints' channels among the columns."""
        wanted = np.repeat(np.isin(np.arange(len(self.means)), joints), 3)
        return np.flatnonzero(np.concatenate([[0 in joints], wanted])[self.kept])

    def values(self, motion: Motion) -> Array:
        """Degrees, shape (n_frames, n_channels)."""
        return _all_values(motion, self.means)[:, self.kept]

    def motion(self, values: Array, like: Motion) -> Motion:
        """Return `like` with these channels; undoes `values`."""
        everything = _all_values(like, self.means)
        everything[:, self.kept] = values
        vectors = np.radians(everything[:, 1:]).reshape(len(values), -1, 3)
        rotations = multiply(self.means, quaternion_from_rotation_vector(vectors))
        rotations[:, 0] = multiply(_yaw_rotation(np.radians(everything[:, 0])), rotations[:, 0])
        return like.with_poses(rotations)


def learn_channels(training: Sequence[Motion]) -> Channels:
    """Choose the channels that move in the training clips, about their means there."""
    rotations = np.concatenate([motion.rotations for motion in training])
    rotations[:, 0] = _without_heading(rotations[:, 0])
    means = mean_rotation(rotations)
    values = [_all_values(motion, means) for motion in training]
    heading = np.concatenate([each[:, :1] - each[:, :1].mean() for each in values])
    rest = np.concatenate([each[:, 1:] for each in values])
    return Channels(means, np.hstack([heading, rest]).std(axis=0) > STILL)


def corrupt(values: Array, sigma: float, fraction: float, rng: np.random.Generator) -> Array:
    """Add Gaussian noise; replace a fraction of the samples by outliers around the truth."""
    noisy = values + sigma * rng.normal(size=values.shape)
    outlying = rng.random(values.shape) < fraction
    size = rng.uniform(*OUTLIERS, size=values.shape) * rng.choice([-1, 1], size=values.shape)
    return np.where(outlying, values + size, noisy)


def corrupt_in_bursts(
    values: Array,
    sigma: float,
    fraction: float,
    groups: Sequence[NDArray[np.intp]],
    rng: np.random.Generator,
) -> Array:
    """Add Gaussian noise; rotate some joints away for a few frames, as a swapped marker does.

    Each group of channels is off for about `fraction` of the frames, in runs of BURSTS frames,
    by one constant rotation of the size of an outlier during a run.
    """
    noisy = values + sigma * rng.normal(size=values.shape)
    n_frames = len(values)
    for group in groups:
        n_runs = rng.poisson(fraction * n_frames / np.mean(BURSTS))
        for start in rng.integers(0, n_frames, size=n_runs):
            run = slice(start, start + int(rng.integers(BURSTS[0], BURSTS[1] + 1)))
            direction = rng.normal(size=len(group))
            noisy[run, group] += rng.uniform(*OUTLIERS) * direction / np.linalg.norm(direction)
    return noisy


def low_passed(shape: tuple[int, int], rate: float, rng: np.random.Generator) -> Array:
    """Return noise of deviation 1 after a filter of 8 Hz, forward and backward: no lag."""
    coefficients = scipy.signal.butter(2, FILTER_HZ, fs=rate)
    noise = scipy.signal.filtfilt(*coefficients, rng.normal(size=shape), axis=0)
    return np.asarray(noise / noise.std())


def one_over_f(shape: tuple[int, int], rng: np.random.Generator) -> Array:
    """Return noise with a power of one over the frequency and standard deviation 1."""
    spectrum = np.fft.rfft(rng.normal(size=shape), axis=0)
    frequencies = np.maximum(np.arange(len(spectrum)), 1.0)
    noise = np.fft.irfft(spectrum / np.sqrt(frequencies)[:, None], n=shape[0], axis=0)
    return np.asarray(noise / noise.std(axis=0))


def seeded(*what: object) -> np.random.Generator:
    """Return the generator of a clip, level or mask: the same in every run."""
    return np.random.default_rng(crc32(repr(what).encode()))


def channel_error(estimate: Array, truth: Array) -> float:
    """Mean absolute error, degrees."""
    return float(np.abs(estimate - truth).mean())


def angle_error(
    estimate: Motion, truth: Motion, joints: NDArray[np.bool_] | Sequence[int]
) -> Array:
    """Geodesic angle between local rotations, degrees, shape (n_frames, number of `joints`)."""
    a, b = estimate.rotations[:, joints], truth.rotations[:, joints]
    return np.degrees(angle_between(a, b))


def _all_values(motion: Motion, means: Array) -> Array:
    rotations = motion.rotations.copy()
    heading = np.unwrap(_heading(rotations[:, 0]))
    rotations[:, 0] = _without_heading(rotations[:, 0])
    vectors = rotation_vector_from_quaternion(multiply(inverse(means), rotations))
    return np.degrees(np.column_stack([heading, vectors.reshape(len(vectors), -1)]))


def _heading(rotations: Array) -> Array:
    return np.asarray(2.0 * np.arctan2(rotations[..., 3], rotations[..., 0]))


def _without_heading(rotations: Array) -> Array:
    return multiply(_yaw_rotation(-_heading(rotations)), rotations)


def _yaw_rotation(angle: Array) -> Array:
    return quaternion_from_rotation_vector(angle[..., None] * (0.0, 0.0, 1.0))
