"""The default method of `denoise`: find outliers, estimate, average with two smoothers."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
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
    N_CHANNELS,
    SHIPPED_PAIRS,
    JointNoise,
    MixtureSmoother,
    estimate_joint_noise,
    find_noise_spectrum,
    load_motion_mixture,
)
from .outliers import confirm_outliers, find_bursts
from .window_estimates import estimate_in_groups, window_length
from .window_priors import WHITE, FilterBases, NoiseSpectrum

OUTLIER_THRESHOLD = 0.5
"""Probability of being an inlier below which a sample is an outlier. By definition."""


class _CompleteTake(NamedTuple):
    """A take whose gaps and outliers are replaced by their estimate."""

    channels: Channels
    """As they were recorded."""
    values: Array
    """Without NaN, shape (n_frames, n_channels)."""
    is_good: Flags
    """Samples that were recorded and are no outliers, same shape."""
    noise: JointNoise
    frame_rate: float


def apply_default_method(
    channels: Channels, frame_rate: float, bases: FilterBases | None, progress: Progress
) -> tuple[Estimate, str]:
    """Return the estimate of all channels, and what it was made with.

    1. The motion mixture finds errors of several frames.
    2. Patterns of the take, and of examples if given, fill gaps and find single outliers. The
       mixture rejects those that people's movement explains, such as a kick.
    3. A smoothing spline and the mixtures of joints and of pairs smooth what remains. Each
       joint is the mean of the three, weighted to have the least expected error. If the noise
       is not white, the take is estimated again with the spectrum of that noise.
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
    noise = estimate_joint_noise(
        np.where(outliers, np.nan, noisy), MIN_NOISE, channels.n_rotations
    )
    take = _CompleteTake(channels, complete, is_good, noise, frame_rate)
    averaged, smoothing = _smooth(take, estimate)
    colors = _colored_noise(take) if len(noisy) >= window_length(bases, frame_rate) else {}
    for spectrum, columns in colors.items():
        colored, prior_used = _smooth_colored_noise(
            take, estimate, bases, spectrum, within(progress, 0.9, 0.95)
        )
        averaged = _with_columns(averaged, colored, columns)
        smoothing = "The jitter lasts several frames, so slower movement was smoothed, too."
    filling = ""
    if bases is None:
        averaged, n_predicted = predict_limbs(
            channels, averaged, frame_rate, load_body_relation(), within(progress, 0.95, 1.0)
        )
        if n_predicted:
            filling = f"Filled long gaps of {_joints(n_predicted)} from the rest of the body."
    return averaged, " ".join(filter(None, (prior_used, smoothing, filling)))


def _colored_noise(take: _CompleteTake) -> dict[NoiseSpectrum, slice]:
    """Return the spectra that are not white, and the columns that have them.

    Those of the position have their own, if the noise of the rotations is not white either.
    """
    n_rotations = take.channels.n_rotations
    if not n_rotations:
        return {}
    shape = len(take.values), -1, N_CHANNELS
    samples, observed = take.values.reshape(shape), take.is_good.reshape(shape).all(axis=2)

    def spectrum_of(joints: slice) -> NoiseSpectrum:
        own = take.noise._replace(
            covariances=take.noise.covariances[joints], is_free=take.noise.is_free[joints]
        )
        return find_noise_spectrum(
            samples[:, joints], own, observed[:, joints], take.frame_rate, load_motion_mixture()
        )

    of_rotations = spectrum_of(slice(None, -1))
    of_position = WHITE if of_rotations.is_white else spectrum_of(slice(-1, None))
    if of_position == of_rotations:
        return {} if of_rotations.is_white else {of_rotations: slice(None)}
    colors = {of_rotations: slice(n_rotations), of_position: slice(n_rotations, None)}
    return {spectrum: columns for spectrum, columns in colors.items() if not spectrum.is_white}


def _smooth_colored_noise(
    take: _CompleteTake,
    first: Estimate,
    bases: FilterBases | None,
    spectrum: NoiseSpectrum,
    progress: Progress,
) -> tuple[Estimate, str]:
    """Return the estimate of a take whose noise is not white, and what it was made with.

    Outliers and gaps, and how uncertain these are, stay those of the first estimate: the second
    one takes what fills them for observed, except where it measures the noise.
    """
    complete = replace(take.channels, values=take.values.reshape(take.channels.values.shape))
    no_errors = np.zeros(take.values.shape, dtype=np.bool_)
    again, prior_used = estimate_in_groups(
        complete, no_errors, take.frame_rate, bases, progress, spectrum, take.is_good
    )
    deviation = np.where(take.is_good, again.deviation, first.deviation)
    again = replace(again, inliers=first.inliers, deviation=deviation)
    mixture = load_motion_mixture()
    length = round(mixture.window * take.frame_rate / mixture.frame_rate)
    noise = take.noise.multiplied(spectrum.deviation_ratio(length))
    colored, _ = _smooth(take._replace(noise=noise), again, spectrum)
    return colored, prior_used


def _with_columns(estimate: Estimate, other: Estimate, columns: slice) -> Estimate:
    """Return an estimate with these columns of another one."""
    arrays = {}
    for name in ("values", "deviation", "leave_one_out_error"):
        arrays[name] = getattr(estimate, name).copy()
        arrays[name][:, columns] = getattr(other, name)[:, columns]
    return replace(estimate, **arrays)


def _smooth(
    take: _CompleteTake, estimate: Estimate, spectrum: NoiseSpectrum = WHITE
) -> tuple[Estimate, str]:
    """Return the mean of the estimate and of two smoothers, and a sentence on the smoothing.

    The spline takes noise that is not white for movement, so it is not used then.
    """
    complete, is_good = take.values, take.is_good
    smoothed = [smooth_by_spline(complete)] if spectrum.is_white else []
    factors = noise_factors(take.noise.deviation, complete, [estimate, *smoothed], is_good)
    noise = take.noise.multiplied(factors)
    mixtures = load_motion_mixture(), load_motion_mixture(SHIPPED_PAIRS, 2)
    smooth_by_mixtures = MixtureSmoother(
        noise.covariances, take.frame_rate, mixtures, take.channels.parents, spectrum
    )
    if (by_mixtures := smooth_by_mixtures(complete)) is not None:
        smoothed.append(by_mixtures)
    deviations = np.maximum(noise.deviation, MIN_NOISE)
    averaged, weights = average_estimates(complete, estimate, smoothed, is_good, deviations)
    n_smoothed = int(np.count_nonzero(weights[:, 0] < 0.5))
    if not n_smoothed:
        return averaged, ""
    joints = _joints(n_smoothed)
    return averaged, (
        f"For {joints}, general smoothing fits better than learned patterns, so"
        " it counts more there."
    )


def _joints(n_joints: int) -> str:
    return "1 joint" if n_joints == 1 else f"{n_joints} joints"
