"""The default method: find errors, estimate, and stack the estimate with two smoothers."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress, within
from ..channels import Channels
from ..limb_gaps import load_body_relation, predict_limbs
from ..motion_mixture import (
    MAX_CONSTANT_RANGE,
    estimate_channel_noise,
    load_motion_mixture,
    smooth_by_mixture,
)
from ..posterior import Estimate, Smoothed, estimate_in_groups
from ..window_priors import FilterBases
from .measure_leverage import leverage, leverage_factor
from .outlier_runs import confirm_outliers, find_bursts
from .smoothing_spline import smooth_by_spline
from .stack_estimates import stack_estimates

OUTLIER_THRESHOLD = 0.5
"""Probability of being an inlier below which a sample is an outlier. By definition."""

MIN_NOISE = 1e-3
"""Degrees or centimeters: smaller noise is that of rounding in files. Guards a division."""


def estimate_and_stack(
    channels: Channels, frame_rate: float, bases: FilterBases | None, progress: Progress
) -> tuple[Estimate, str]:
    """Return the estimate of all channels, and what it was made with.

    1. The motion mixture finds errors of several frames.
    2. Patterns of the take, and of examples if given, fill gaps and find single outliers. The
       mixture rejects those that people's movement explains, such as a kick.
    3. A smoothing spline and the mixture smooth what remains. Each joint is the mean of the
       three, weighted to have the least expected error.
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
    rotations = slice(channels.n_rotations)
    bursts[:, rotations] = find_bursts(noisy[:, rotations], frame_rate, mixture)
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
    noise = estimate_channel_noise(np.where(is_good, noisy, np.nan), MIN_NOISE)
    spline = smooth_by_spline(complete)
    factors = noise_factors(noise, complete, [estimate, spline], is_good)
    noise = np.maximum(noise * factors, MIN_NOISE)
    by_mixture = partial(smooth_by_mixture, noise=noise, frame_rate=frame_rate, mixture=mixture)
    stacked, weights = stack_estimates(
        noisy,
        estimate,
        [
            (smoothed, leverage_factor(smooth, complete, is_good, noise))
            for smooth, smoothed in (
                (smooth_by_spline, spline),
                (by_mixture, by_mixture(complete)),
            )
            if smoothed is not None
        ],
        is_good,
        noise,
    )
    n_predicted = 0
    if bases is None:
        stacked, n_predicted = predict_limbs(
            channels, stacked, frame_rate, load_body_relation(), within(progress, 0.95, 1.0)
        )
    sentence = _describe(int(np.count_nonzero(weights[:, 0] < 0.5)), n_predicted)
    return stacked, f"{prior_used} {sentence}".strip()


def noise_factors(
    noise: Array,
    complete: Array,
    candidates: Sequence[Estimate | Smoothed],
    is_good: NDArray[np.bool_],
) -> Array:
    """Return how much smaller the noise is than third differences say, shape (n_channels,).

    They take fast movement for noise, which would then be smoothed away. What the best of the
    candidates leaves holds less movement. They may follow noise, too: no joint's factor is less
    than the median of all channels.
    """
    moves = np.ptp(complete, axis=0) > MAX_CONSTANT_RANGE
    if not moves.any():
        return np.ones_like(noise)
    factors = [_noise_factors_of(noise, complete, each, is_good, moves) for each in candidates]
    return np.asarray(np.min(factors, axis=0))


def _noise_factors_of(
    noise: Array,
    complete: Array,
    candidate: Estimate | Smoothed,
    is_good: NDArray[np.bool_],
    moves: NDArray[np.bool_],
) -> Array:
    residuals = np.where(is_good, complete - candidate.values, 0.0)
    free = np.where(is_good, 1.0 - leverage(residuals, candidate.leave_one_out_error), 0.0)
    left = np.sqrt((residuals**2).sum(axis=0) / np.maximum(free.sum(axis=0), 1.0))
    logs = np.log(np.maximum(left, MIN_NOISE) / noise)
    of_joints = np.where(moves, logs, 0.0).reshape(-1, 3).sum(axis=1)
    of_joints /= np.maximum(moves.reshape(-1, 3).sum(axis=1), 1)
    logs = np.maximum(np.repeat(of_joints, 3), np.median(logs[moves]))
    return np.asarray(np.exp(np.minimum(logs, 0.0)))


def _describe(n_smoothed: int, n_predicted: int) -> str:
    sentences = []
    if n_smoothed:
        joints = _joints(n_smoothed)
        sentences.append(
            f"Plain smoothing and a model of how people move predict {joints} better."
        )
    if n_predicted:
        sentences.append(f"Long gaps of {_joints(n_predicted)} are filled by how people move.")
    return " ".join(sentences)


def _joints(n_joints: int) -> str:
    return "1 joint" if n_joints == 1 else f"{n_joints} joints"
