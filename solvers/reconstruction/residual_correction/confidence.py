"""Probability that a joint is near the position that a residual prior predicts."""

from functools import cache
from typing import NamedTuple

import numpy as np
import scipy

from ...arrays import Array

MIN_VARIANCE_M2 = 1e-12
"""Minimum variance (m²); smaller ones carry no information. It guards a division."""


class Calibration(NamedTuple):
    """Mapping from predicted variances to those of actors outside the training set.

    The log variance of a new actor's joint is normal about `level + shift + slope (predicted -
    level)`, where `level` is the mean predicted log variance of a take.

    Attributes
    ----------
    shift : float
        Mean difference of log variances.
    slope : float
        Fraction of predicted differences that is found: 1 all, 0 none.
    spread : float
        Standard deviation of the logarithm, between actors and joints.
    """

    shift: float = 0.0
    slope: float = 1.0
    spread: float = 0.0


IDENTITY_CALIBRATION = Calibration()


def probability_within(
    variances: Array,
    distance: float,
    calibration: Calibration = IDENTITY_CALIBRATION,
    level: float | None = None,
) -> Array:
    """Return the probability of a point within a distance of its mean (Maxwell distribution).

    The variance of a new actor is itself uncertain; probabilities are averaged over its
    distribution by Gauss-Hermite quadrature.

    Parameters
    ----------
    variances : any shape, square meters for each of three axes; infinite: chance 0
        Of one take.
    distance : float, meters
    calibration : Calibration
    level : float, optional
        `mean_log_variance` of the take; by default that of these variances.
    """
    shift, slope, spread = calibration
    known = np.isfinite(variances)
    log_variances = np.log(np.maximum(np.where(known, variances, 1.0), MIN_VARIANCE_M2))
    level = mean_log_variance(variances) if level is None else level
    scaled_distance = (
        0.5 * distance**2 * np.exp(-level - shift - slope * (log_variances - level))
    )
    nodes = _quadrature() if spread else [(0.0, 1.0)]
    chance = sum(
        fraction * scipy.special.gammainc(1.5, scaled_distance * np.exp(-spread * node))
        for node, fraction in nodes
    )
    return np.where(known, chance, 0.0)


@cache
def _quadrature() -> list[tuple[float, float]]:
    """Return nodes of Gauss-Hermite quadrature and their weights, which sum to 1."""
    nodes, weights = scipy.special.roots_hermitenorm(7)
    return list(zip(nodes.tolist(), (weights / weights.sum()).tolist(), strict=True))


def mean_log_variance(variances: Array) -> float:
    """Return the mean logarithm of the finite variances, (...) m²; 0 if there is none."""
    known = variances[np.isfinite(variances)]
    return float(np.log(np.maximum(known, MIN_VARIANCE_M2)).mean()) if known.size else 0.0
