"""Whether a tracked pose is wrong: a learned chance, or the thresholds of the paper."""

import numpy as np
from numpy.typing import NDArray

from ...settings import Choice
from .fit_quality import FITTING, FitQuality

Array = NDArray[np.float64]

PUBLISHED_RESIDUAL, PUBLISHED_OVERLAP = 0.025, 0.9
"""Metres and share of [WZC12] section 5: above or below them, a pose has failed."""
FEATURES = ("residual", "overlap", "score", "off actor", "too near", "unexplained")
LEARNED = (1.32, -6.22, -6.01, 2.72, 0.59, 5.65)
LEARNED_BIAS = 5.77
"""Weights of `FEATURES` in the log-odds that joints are off by more than 10 cm on average."""


class FailureTest(Choice):
    """How a failed pose is told."""

    LEARNED = "learned", "Use a learned failure probability and the typical fit"
    PUBLISHED = (
        "published",
        "Use the thresholds of Wei et al. (2012): 2.5 cm, 90 % overlap",
        "Wei et al. 2012",
    )


def failure_features(quality: FitQuality) -> Array:
    """Return the `FEATURES` of a pose, shape (6,)."""
    residual = quality.residual if np.isfinite(quality.residual) else FITTING
    return np.array([
        residual / FITTING, quality.coverage, quality.score, quality.off_actor,
        quality.too_near, quality.unexplained,
    ])  # fmt: skip


def failure_chance(quality: FitQuality) -> float:
    """Return the chance, 0 to 1, that the joints of a pose are off by more than 10 cm.

    A logistic regression; `.ci/learn_failures.py` learned it from trackers of known errors.
    """
    odds = float(failure_features(quality) @ LEARNED) + LEARNED_BIAS
    return float(1.0 / (1.0 + np.exp(-odds)))


def has_failed(quality: FitQuality, test: FailureTest, chance: float = 0.5) -> bool:
    """Tell whether a pose has failed.

    Parameters
    ----------
    quality : FitQuality
    test : FailureTest
        `PUBLISHED` is that of [WZC12]_, section 5: depths 2.5 cm apart, or less than 90 %
        overlap.
    chance : float
        Of having failed, from which on `LEARNED` says so.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    if test is FailureTest.LEARNED:
        return failure_chance(quality) >= chance
    fits = quality.residual <= PUBLISHED_RESIDUAL and quality.coverage >= PUBLISHED_OVERLAP
    return not fits
