"""The chance that a joint lies near where a residual prior puts it, for somebody new."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import gammainc, roots_hermitenorm

Array = NDArray[np.float64]

MIN_VARIANCE_M2 = 1e-12
"""Square metres. Variances below this tell nothing more."""
NODES, _WEIGHTS = roots_hermitenorm(7)
NODE_WEIGHTS = _WEIGHTS / _WEIGHTS.sum()


class Calibration(NamedTuple):
    """How the variances of new actors follow from those that a prior foretells.

    The logarithm of a new actor's variance of a joint is normal about
    `level + shift + slope (told - level)`, where `level` is the mean of what is told of a take.

    Attributes
    ----------
    shift : float
        By how much variances are larger on the whole, as a logarithm.
    slope : float
        What part of told differences is found again: 1 all, 0 none.
    spread : float
        Standard deviation of the logarithm, between actors and joints.
    """

    shift: float = 0.0
    slope: float = 1.0
    spread: float = 0.0


IDENTITY_CALIBRATION = Calibration()


def chance_within(
    variances: Array, distance: float, calibration: Calibration = IDENTITY_CALIBRATION
) -> Array:
    """Return the chance of a point being within a distance of its mean (Maxwell's law).

    The variance of a new actor is not known either; chances are averaged over what it may be,
    by Gauss-Hermite quadrature.

    Parameters
    ----------
    variances : any shape, square metres for each of three axes; infinite: chance 0
        Of one take.
    distance : float, metres
    calibration : Calibration
    """
    shift, slope, spread = calibration
    known = np.isfinite(variances)
    told = np.log(np.maximum(np.where(known, variances, 1.0), MIN_VARIANCE_M2))
    level = float(told[known].mean()) if known.any() else 0.0
    nearness = 0.5 * distance**2 * np.exp(-level - shift - slope * (told - level))
    nodes = zip(NODES, NODE_WEIGHTS, strict=True) if spread else [(0.0, 1.0)]
    chance = sum(
        share * gammainc(1.5, nearness * np.exp(-spread * node)) for node, share in nodes
    )
    return np.where(known, chance, 0.0)
