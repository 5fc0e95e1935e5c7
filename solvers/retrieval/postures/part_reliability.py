"""How far what a part of the body does is known, though some of its joints were lost."""

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS
from .body_parts import JOINTS, N_PARTS, ROOTS
from .mean_postures import POSITION_NOISE_M, PostureDistribution

Array = NDArray[np.float64]

MIN_OBSERVED_FRACTION = 0.5
"""Share of the frames in which a joint is seen that counts as one that is known."""
MIN_RELIABILITY = 0.02
MIN_VARIANCE_M2 = 1e-9


def part_reliability(seen: NDArray[np.bool_], usual: PostureDistribution) -> Array:
    """Return the share of each part's variance that joints which are seen tell, shape (5,).

    1 for all that was tracked. A lost elbow between a shoulder and a hand costs little, a lost
    hand much, and of an arm that was not seen at all the rest of the body tells something.

    Parameters
    ----------
    seen : shape (n_frames, 20)
    """
    known = np.repeat(seen.mean(axis=0) > MIN_OBSERVED_FRACTION, 3)
    if known.all():
        return np.ones(N_PARTS)
    lost, all_of = ~known, usual.covariance
    among = all_of[np.ix_(known, known)] + POSITION_NOISE_M**2 * np.eye(known.sum())
    across = all_of[np.ix_(known, lost)]
    left = np.zeros_like(all_of)
    left[np.ix_(lost, lost)] = all_of[np.ix_(lost, lost)] - across.T @ np.linalg.solve(
        among, across
    )
    doubt = _variances(left) / np.maximum(_variances(all_of), MIN_VARIANCE_M2)
    return np.asarray(np.clip(1.0 - doubt, MIN_RELIABILITY, 1.0))


def _variances(covariance: Array) -> Array:
    """Return the variance of each part's joints from where it hangs, shape (5,)."""
    among = covariance.reshape(N_JOINTS, 3, N_JOINTS, 3).trace(axis1=1, axis2=3)
    own = among.diagonal()
    roots = ROOTS[:, None]
    return np.asarray((own[JOINTS] + own[roots] - 2.0 * among[JOINTS, roots]).sum(axis=-1))
