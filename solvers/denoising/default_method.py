"""The default method of `denoise`: find outliers, estimate, average with two smoothers."""

from dataclasses import replace

import numpy as np

from ..progress import Progress, within
from .averaging import (
    MIN_NOISE,
    average_estimates,
    noise_factors,
    smooth_by_spline,
)
from .channels import Channels, Estimate
from .limb_gaps import load_body_relation, predict_limbs
from .motion_model import (
    SHIPPED_PAIRS,
    MixtureSmoother,
    estimate_joint_noise,
    load_motion_mixture,
)
from .outliers import confirm_outliers, find_bursts
from .window_estimates import estimate_in_groups
from .window_priors import FilterBases

OUTLIER_THRESHOLD = 0.5
"""Probability of being an inlier below which a sample is an outlier. By definition."""


def apply_default_method(
    channels: Channels, frame_rate: float, bases: FilterBases | None, progress: Progress
) -> tuple[Estimate, str]:
    """Return the estimate of all channels, and what it was made with.

    1. The motion mixture finds errors of several frames.
    2. Patterns of the take, and of examples if given, fill gaps and find single outliers. The
       mixture rejects those that people's movement explains, such as a kick.
    3. A smoothing spline and the mixtures of joints and of pairs smooth what remains. Each
       joint is the mean of the three, weighted to have the least expected error.
    4. Without examples, joints that are missing for long are predicted from the others.

    Parameters
    ----------
    channels : Channels
    frame_rate : float, Hz
    bases : FilterBases, optional
    progress : Progress
    """
    noisy, mixture = channels.flat, load_motion_mixture()
    progress(0.0, "Finding errors")
    bursts = np.zeros(noisy.shape, dtype=np.bool_)
    if channels.n_rotations:
        bursts = find_bursts(noisy, frame_rate, mixture)
    estimate, prior_used = estimate_in_groups(
        channels, bursts, frame_rate, bases, within(progress, 0.1, 0.9)
    )
    progress(0.9, "Smoothing")
    known = np.isfinite(noisy) & np.isfinite(estimate.leave_one_out_error)
    suspected = known & (estimate.inliers < OUTLIER_THRESHOLD)
    complete = np.where(known & ~suspected, noisy, estimate.values)
    outliers = confirm_outliers(noisy, suspected, complete, frame_rate, mixture)
    is_good = known & ~outliers
    estimate = replace(estimate, inliers=np.where(known, ~outliers, estimate.inliers))
    complete = np.where(is_good, noisy, estimate.values)
    covariances, noise = estimate_joint_noise(np.where(outliers, np.nan, noisy), MIN_NOISE)
    spline = smooth_by_spline(complete)
    factors = noise_factors(noise, complete, [estimate, spline], is_good)
    noise = np.maximum(noise * factors, MIN_NOISE)
    smooth_by_mixtures = MixtureSmoother(
        covariances * np.square(factors[::3])[:, None, None],
        frame_rate,
        (mixture, load_motion_mixture(SHIPPED_PAIRS, 2)),
        channels.parents,
    )
    smoothed = [spline, smooth_by_mixtures(complete)]
    averaged, weights = average_estimates(
        noisy, estimate, [each for each in smoothed if each is not None], is_good, noise
    )
    n_predicted = 0
    if bases is None:
        averaged, n_predicted = predict_limbs(
            channels, averaged, frame_rate, load_body_relation(), within(progress, 0.95, 1.0)
        )
    sentence = _describe(int(np.count_nonzero(weights[:, 0] < 0.5)), n_predicted)
    return averaged, f"{prior_used} {sentence}".strip()


def _describe(n_smoothed: int, n_predicted: int) -> str:
    sentences = []
    if n_smoothed:
        joints = _joints(n_smoothed)
        sentences.append(
            f"For {joints}, general smoothing fits better than learned patterns, so it counts"
            " more there."
        )
    if n_predicted:
        sentences.append(
            f"Filled long gaps of {_joints(n_predicted)} from the rest of the body."
        )
    return " ".join(sentences)


def _joints(n_joints: int) -> str:
    return "1 joint" if n_joints == 1 else f"{n_joints} joints"
