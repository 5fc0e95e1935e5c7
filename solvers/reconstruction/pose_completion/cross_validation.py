"""How wrong a limb would be synthesised, measured where it is seen, by leaving it out."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Synthesis = Callable[[Indices, Array], Array]
"""From the numbers of frames, and how far joints are trusted there, to postures."""

LIMBS = ((4, 5, 6, 7), (8, 9, 10, 11), (12, 13, 14, 15), (16, 17, 18, 19), (3,))
"""Arms, legs and head, as places among `POSTURE_JOINTS`."""
MAX_FRAMES = 60
MIN_RELIABILITY = 0.5
HALF_WEIGHT_FRAMES = 6.0
"""Frames at which half of an offset is believed."""
DEFAULT_ERROR_M, MIN_ERROR_M, MAX_ERROR_M = 0.1, 0.03, 0.25


class SynthesisErrors(NamedTuple):
    """What to expect of joints that are synthesised without being seen.

    Attributes
    ----------
    offset : shape (20, 3), metres
        Constant part of seen less synthesised.
    size : shape (20,), metres
        Root of the mean square of the rest, of one coordinate.
    """

    offset: Array
    size: Array


def cross_validate_limbs(
    postures: Array, trust: Array, synthesise: Synthesis
) -> SynthesisErrors:
    """Synthesise frames without one limb after the other, and compare it with what was seen.

    Parameters
    ----------
    postures : shape (n_frames, 20, 3), metres
    trust : shape (n_frames, 20)
    synthesise : Synthesis
    """
    offset, size = np.zeros((N_JOINTS, 3)), np.full(N_JOINTS, DEFAULT_ERROR_M)
    size[:3] = MIN_ERROR_M
    for limb in map(list, LIMBS):
        told = np.isfinite(postures[:, limb]).all(axis=-1)
        seen = np.where(told, trust[:, limb], 0.0)
        sure = np.flatnonzero((seen > MIN_RELIABILITY).sum(axis=1) > len(limb) / 2)
        if not len(sure):
            continue
        frames = sure[np.unique(np.linspace(0, len(sure) - 1, MAX_FRAMES).astype(int))]
        without = trust[frames].copy()
        without[:, limb] = 0.0
        off = (postures[frames] - synthesise(frames, without))[:, limb]
        weight = np.where(seen[frames] > MIN_RELIABILITY, seen[frames], 0.0)
        off = np.where(weight[..., None] > 0.0, off, 0.0)
        total = weight.sum(axis=0)
        mean = np.einsum("fi,fik->ik", weight, off) / (total + HALF_WEIGHT_FRAMES)[:, None]
        rest = np.einsum("fi,fik->i", weight, (off - mean) ** 2) / 3.0
        rest = (rest + HALF_WEIGHT_FRAMES * DEFAULT_ERROR_M**2) / (total + HALF_WEIGHT_FRAMES)
        for place in range(1, len(limb)):
            if total[place] == 0.0:  # never seen: where the joint above goes, it goes
                mean[place] = mean[place - 1]
        offset[limb] = mean
        size[limb] = np.clip(np.sqrt(rest), MIN_ERROR_M, MAX_ERROR_M)
    return SynthesisErrors(offset, size)
