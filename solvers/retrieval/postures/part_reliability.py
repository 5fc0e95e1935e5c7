"""Estimate the reliability of a body part with missing joints."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion.humanoid import N_JOINTS
from .body_parts import JOINTS, N_PARTS, ROOTS
from .mean_postures import MIN_OBSERVED_FRACTION, POSITION_NOISE_M, PostureDistribution

MIN_PART_RELIABILITY = 0.02
"""Lower bound of the reliability of a part. It guards queries without an observed part."""
MIN_VARIANCE_M2 = 1e-9
"""Minimum variance that is divided by. It guards a division."""


def part_reliability(observed: NDArray[np.bool_], distribution: PostureDistribution) -> Array:
    """Return the fraction of the variance of each part that is explained, shape (5,).

    1 for a fully tracked body. A missing elbow between shoulder and hand costs little, a
    missing hand much; the rest of the body explains a small fraction of a missing arm.

    Parameters
    ----------
    observed : shape (n_frames, 20)
    """
    known = np.repeat(observed.mean(axis=0) > MIN_OBSERVED_FRACTION, 3)
    if known.all():
        return np.ones(N_PARTS)
    missing, covariance = ~known, distribution.covariance
    known_covariance = covariance[np.ix_(known, known)] + POSITION_NOISE_M**2 * np.eye(
        known.sum()
    )
    cross_covariance = covariance[np.ix_(known, missing)]
    residual = np.zeros_like(covariance)
    residual[np.ix_(missing, missing)] = covariance[
        np.ix_(missing, missing)
    ] - cross_covariance.T @ np.linalg.solve(known_covariance, cross_covariance)
    unexplained = _variances(residual) / np.maximum(_variances(covariance), MIN_VARIANCE_M2)
    return np.asarray(np.clip(1.0 - unexplained, MIN_PART_RELIABILITY, 1.0))


def _variances(covariance: Array) -> Array:
    """Return the variance of the joints of each part from its reference joint, shape (5,)."""
    traces = covariance.reshape(N_JOINTS, 3, N_JOINTS, 3).trace(axis1=1, axis2=3)
    own = traces.diagonal()
    roots = ROOTS[:, None]
    return np.asarray((own[JOINTS] + own[roots] - 2.0 * traces[JOINTS, roots]).sum(axis=-1))
