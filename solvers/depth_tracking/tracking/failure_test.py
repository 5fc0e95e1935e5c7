"""Failure test of a tracked pose: learned probability, or the thresholds of the paper."""

import numpy as np

from ...arrays import Array
from ...settings import Choice
from .fit_quality import MAX_DEPTH_ERROR_M, FitQuality

PUBLISHED_MAX_RESIDUAL_M, PUBLISHED_MIN_OVERLAP = 0.025, 0.9
"""Meters and fraction: thresholds of [WZC12] section 5 for residual (above) and overlap
(below)."""
FEATURES = ("residual", "overlap", "score", "off actor", "too near", "unexplained")
LEARNED_WEIGHTS = (1.32, -6.22, -6.01, 2.72, 0.59, 5.65)
"""Weight of each of `FEATURES` in the log-odds that joints are off by more than 10 cm on
average. Learned by `tests/training/learn_failures.py`, on clips and bodies of its own."""
LEARNED_BIAS = 5.77
"""The constant term, a weight without a feature. Learned by the same script."""


class FailureTest(Choice):
    """Method of the failure test."""

    LEARNED = "learned", "Use a learned failure probability and the typical fit"
    PUBLISHED = (
        "published",
        "Use the thresholds of Wei et al. (2012): 2.5 cm, 90 % overlap",
        "Wei et al. 2012",
    )


def failure_features(quality: FitQuality) -> Array:
    """Return the `FEATURES` of a pose, shape (6,)."""
    residual = quality.residual if np.isfinite(quality.residual) else MAX_DEPTH_ERROR_M
    return np.array([
        residual / MAX_DEPTH_ERROR_M, quality.coverage, quality.score, quality.off_actor,
        quality.too_near, quality.unexplained,
    ])  # fmt: skip


def failure_probability(quality: FitQuality) -> float:
    """Return the probability that the mean joint error of a pose exceeds 10 cm.

    A logistic regression; `tests/training/learn_failures.py` fits the weights, with truth.
    """
    odds = float(failure_features(quality) @ LEARNED_WEIGHTS) + LEARNED_BIAS
    return float(1.0 / (1.0 + np.exp(-odds)))


def has_failed(quality: FitQuality, test: FailureTest, chance: float = 0.5) -> bool:
    """Return whether a pose has failed.

    Parameters
    ----------
    quality : FitQuality
    test : FailureTest
        `PUBLISHED` uses [WZC12]_, section 5: residual above 2.5 cm or overlap below 90 %.
    chance : float
        Probability threshold of `LEARNED`.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    if test is FailureTest.LEARNED:
        return failure_probability(quality) >= chance
    fits = (
        quality.residual <= PUBLISHED_MAX_RESIDUAL_M
        and quality.coverage >= PUBLISHED_MIN_OVERLAP
    )
    return not fits
