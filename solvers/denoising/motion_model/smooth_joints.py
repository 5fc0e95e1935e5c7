"""Smooth every joint of a complete take, alone and together with its neighbors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..channels import Smoothed
from ..window_priors import WHITE, NoiseSpectrum
from .joint_groups import find_joint_groups
from .joint_noise import MAX_CONSTANT_RANGE
from .motion_mixture import N_CHANNELS, MotionMixture
from .smooth_groups import GroupSmoother

MIN_VARIANCE = np.finfo(float).tiny
"""Guards a division."""
MAX_LEVERAGE = 1.0 - 1e-9
"""Largest weight of a sample in its own estimate. Guards a division."""


@dataclass(frozen=True, eq=False)
class MixtureSmoother:
    """Estimate every joint as the weighted mean over all groups that it belongs to.

    With a mixture of joints and one of pairs, a joint is estimated alone, with its parent, and
    with each of its children: movement of one hints at movement of the other. Their weights
    are inverse to the mean variance of their errors over the take.

    Attributes
    ----------
    noise : shape (n_joints, 3, 3)
        Covariances, square degrees or centimeters; see `JointNoise`.
    frame_rate : float, Hz
    mixtures : sequence of MotionMixture
        The first one is of joints.
    parents : shape (n_joints,), optional
        -1 where there is none. Points have none.
    noise_spectrum : NoiseSpectrum
    """

    noise: Array
    frame_rate: float
    mixtures: Sequence[MotionMixture]
    parents: NDArray[np.intp] | None = None
    noise_spectrum: NoiseSpectrum = WHITE

    def __call__(self, samples: Array) -> Smoothed | None:
        """Return the smoothed take; None if it is shorter than a window.

        Parameters
        ----------
        samples : shape (n_frames, n_channels), without NaN
            Degrees, or centimeters of the root; each joint has three channels.
        """
        average = samples.mean(axis=0)
        joints = (samples - average).reshape(len(samples), -1, N_CHANNELS)
        moves = (np.ptp(joints, axis=0) > MAX_CONSTANT_RANGE).any(axis=-1)
        parents = np.full(len(moves), -1) if self.parents is None else self.parents
        total, variance = np.zeros_like(joints), np.zeros_like(joints)
        total_weight = np.zeros((len(moves), 1))
        for mixture in self.mixtures:
            n_joints, size = mixture.n_joints, N_CHANNELS * mixture.n_joints
            groups = find_joint_groups(parents, moves, n_joints)
            noise = self._noise_of(groups).reshape(len(groups), size, size)
            smooth = GroupSmoother(noise, self.frame_rate, mixture, self.noise_spectrum)
            if len(samples) < smooth.length:
                return None
            found = smooth(joints[:, groups].reshape(len(samples), len(groups), size))
            shape = len(samples), len(groups), n_joints, N_CHANNELS
            values, variances = (each.reshape(shape) for each in found)
            weights = 1.0 / np.maximum(variances.mean(axis=(0, 3)), MIN_VARIANCE)
            for index, members in enumerate(groups):
                weight = weights[index, :, None]
                total[:, members] += weight * values[:, index]
                variance[:, members] += weight * variances[:, index]
                total_weight[members] += weight
        total_weight = np.where(total_weight > 0.0, total_weight, 1.0)
        smoothed = (total / total_weight).reshape(samples.shape) + average
        variance = (variance / total_weight).reshape(samples.shape)
        leverage = variance / np.einsum("jcc->jc", self.noise).ravel()
        error = (samples - smoothed) / (1.0 - np.minimum(leverage, MAX_LEVERAGE))
        return Smoothed(smoothed, error, variance)

    def _noise_of(self, groups: NDArray[np.intp]) -> Array:
        """Return the covariances of groups, whose joints have independent noise.

        Shape (n_groups, n_joints, 3, n_joints, 3).
        """
        n_groups, n_joints = groups.shape
        blocks = np.zeros((n_groups, n_joints, N_CHANNELS, n_joints, N_CHANNELS))
        own = np.arange(n_joints)
        blocks[:, own, :, own] = self.noise[groups].swapaxes(0, 1)
        return blocks
