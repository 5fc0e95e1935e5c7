"""Estimate the synthesis error of each limb by leave-one-limb-out cross-validation."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Integers
from ...motion.humanoid import N_JOINTS
from ..reliability import OBSERVED_RELIABILITY

Synthesis = Callable[[Integers, Array], Array]
"""Function from frame indices and joint reliabilities in these frames to postures."""

LIMBS = ((4, 5, 6, 7), (8, 9, 10, 11), (12, 13, 14, 15), (16, 17, 18, 19), (3,))
"""Arms, legs and head, as indices into `POSTURE_JOINTS`."""
MAX_FRAMES = 60
"""Frames, evenly spaced, in which a limb is held out. It bounds the run time."""
HALF_WEIGHT_FRAMES = 6.0
"""Number of frames at which a measured offset gets half its weight. Half and twice are no
better (`make sensitivity`)."""
DEFAULT_ERROR_M = 0.1
"""Meters: expected error of a joint without observations. Half and twice are no better
(`make sensitivity`)."""


class SynthesisErrors(NamedTuple):
    """Expected errors of joints that are synthesized without being observed.

    Attributes
    ----------
    offset : shape (20, 3), meters
        Constant part of observed minus synthesized positions.
    size : shape (20,), meters
        Root mean square of the remainder, per coordinate.
    """

    offset: Array
    size: Array


def cross_validate_limbs(
    postures: Array, reliability: Array, synthesize: Synthesis
) -> SynthesisErrors:
    """Synthesize frames without one limb at a time, and compare with the observed limb.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), meters
    reliability : shape (n_frames, 20)
    synthesize : Synthesis
    """
    offset, size = np.zeros((N_JOINTS, 3)), np.full(N_JOINTS, DEFAULT_ERROR_M)
    for limb in map(list, LIMBS):
        is_observed = np.isfinite(postures[:, limb]).all(axis=-1)
        observed = np.where(is_observed, reliability[:, limb], 0.0)
        usable = np.flatnonzero((observed > OBSERVED_RELIABILITY).sum(axis=1) > len(limb) / 2)
        if not len(usable):
            continue
        frames = usable[np.unique(np.linspace(0, len(usable) - 1, MAX_FRAMES).astype(int))]
        held_out = reliability[frames].copy()
        held_out[:, limb] = 0.0
        residuals = (postures[frames] - synthesize(frames, held_out))[:, limb]
        weight = np.where(observed[frames] > OBSERVED_RELIABILITY, observed[frames], 0.0)
        residuals = np.where(weight[..., None] > 0.0, residuals, 0.0)
        total = weight.sum(axis=0)
        mean = (
            np.einsum("fi,fik->ik", weight, residuals) / (total + HALF_WEIGHT_FRAMES)[:, None]
        )
        variance = np.einsum("fi,fik->i", weight, (residuals - mean) ** 2) / 3.0
        variance = (variance + HALF_WEIGHT_FRAMES * DEFAULT_ERROR_M**2) / (
            total + HALF_WEIGHT_FRAMES
        )
        for index in range(1, len(limb)):
            if total[index] == 0.0:  # never observed: use the offset of the joint above
                mean[index] = mean[index - 1]
        offset[limb] = mean
        size[limb] = np.sqrt(variance)
    return SynthesisErrors(offset, size)
