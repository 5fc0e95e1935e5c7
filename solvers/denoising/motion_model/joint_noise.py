"""Estimate the noise of each joint of a take along the joint's own axes."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ...signals import DIFFERENCE_EFFICIENCY, DIFFERENCE_ORDER, estimate_noise, shrink_noise

MAX_CONSTANT_RANGE = 1e-7
"""Degrees or centimeters over which a channel that stands still varies. Guards against rounding
errors."""
MIN_FREE_NOISE = 0.01
"""Fraction of a joint's largest noise below which the joint cannot turn about an axis. By
definition: a hundredth of the noise changes no estimate."""
MAX_EQUAL_RATIO = 3.0
"""Noise along an axis, relative to the mean of the joint, above which it is the axis's own.
Measured: with fast movement the ratio is up to 2."""
MAX_EQUAL_POSITION_RATIO = 1.5
"""Noise of a position along an axis, relative to the mean, above which each axis has its own:
cameras measure depth least exactly. Measured on the development takes of the first press: where
the noise is equal and large, the ratio is 1.4 at most."""


class JointNoise(NamedTuple):
    """The noise of the channels of a take."""

    covariances: Array
    """Of each joint as a smoother expects it, shape (n_joints, 3, 3): the same along all axes,
    also along fixed ones, where no movement is lost by it."""
    deviation: Array
    """Standard deviation of each channel, shape (3 n_joints,): that of fixed axes is their
    own."""
    is_free: Flags
    """Whether a joint can turn about all of its axes, shape (n_joints,)."""

    def multiplied(self, factors: Array | float) -> "JointNoise":
        """Return the noise with deviations multiplied by these factors, one for each channel
        and the same for those of a joint."""
        deviation = self.deviation * factors
        of_joints = np.broadcast_to(factors, deviation.shape)[::3, None, None]
        return self._replace(
            covariances=self.covariances * np.square(of_joints), deviation=deviation
        )


def estimate_joint_noise(
    samples: Array, minimum: float, n_rotations: int | None = None
) -> JointNoise:
    """Estimate the noise of each joint along its own axes.

    It is equal along the axes about which the joint can turn, unless it is much larger along
    one of them, and along those of a position, unless it is larger along one of them. Axes that
    a joint cannot turn about, as those of a knee that only bends, are fixed and do not count.
    Joints that stand still do not count for the others; they get the others' noise.

    Parameters
    ----------
    samples : shape (n_frames, 3 n_joints)
        NaN where missing.
    minimum : float
        Smallest noise, degrees or centimeters.
    n_rotations : int, optional
        Number of channels, the first ones, that are rotations; the others are positions. All
        are, if it is not given.
    """
    joints = samples.reshape(len(samples), -1, 3)
    axes = _noise_axes(joints)
    along = np.einsum("tjc,jca->tja", joints, axes)
    known = np.isfinite(along)
    highest = np.where(known, along, -np.inf).max(axis=0)
    moves = highest - np.where(known, along, np.inf).min(axis=0) > MAX_CONSTANT_RANGE
    noise = estimate_noise(along.reshape(samples.shape)).reshape(-1, 3)
    is_free = moves & (noise > MIN_FREE_NOISE * noise.max(axis=1, keepdims=True))
    noise = np.maximum(noise, minimum)
    n_free = is_free.sum(axis=1)
    logs = np.where(is_free, np.log(noise), 0.0).sum(axis=1) / np.maximum(n_free, 1)
    mean = np.where(n_free > 0, np.exp(logs), minimum)
    differences = np.diff(along, DIFFERENCE_ORDER, axis=0)
    n_samples = n_free * np.isfinite(differences).all(axis=2).sum(axis=0)
    mean = np.maximum(shrink_noise(mean, n_samples, DIFFERENCE_EFFICIENCY), minimum)[:, None]
    is_own = noise > MAX_EQUAL_RATIO * mean
    positions = slice(len(noise) if n_rotations is None else n_rotations // 3, None)
    unequal = noise[positions] > MAX_EQUAL_POSITION_RATIO * mean[positions]
    is_own[positions] |= unequal.any(axis=1, keepdims=True)
    equal = np.where(is_own, noise, mean)
    is_fixed = ~is_free & (n_free > 0)[:, None]
    own = _covariances(axes, np.where(is_fixed, noise, equal))
    deviation = np.sqrt(np.einsum("jcc->jc", own)).ravel()
    return JointNoise(_covariances(axes, equal), deviation, is_free.all(axis=1))


def _covariances(axes: Array, deviations: Array) -> Array:
    return np.asarray(np.einsum("jca,ja,jda->jcd", axes, np.square(deviations), axes))


def _noise_axes(joints: Array) -> Array:
    """Return the principal axes of the directions of third differences, shape (n_joints, 3, 3).

    Columns are unit vectors.
    """
    differences = np.diff(joints, DIFFERENCE_ORDER, axis=0)
    lengths = np.linalg.norm(differences, axis=2, keepdims=True)
    known = lengths > MAX_CONSTANT_RANGE
    unit = np.where(known, differences / np.where(known, lengths, 1.0), 0.0)
    return np.asarray(np.linalg.eigh(np.einsum("tjc,tjd->jcd", unit, unit))[1])
