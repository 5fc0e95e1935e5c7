"""The filter of Lou and Chai (2010) as published: a choice of Clean, and its baseline."""

import numpy as np

from ..arrays import Array
from ..progress import Progress
from ..signals import fill_channel_gaps, remove_outliers
from .channels import Channels, Estimate
from .outliers import OFFSET_DEVIATION
from .window_priors import (
    FilterBases,
    FilterBasesSettings,
    LagProducts,
    find_leading_eigenpairs,
)

KEPT_ENERGY = 0.99
"""Fraction of the movement that the patterns hold. From [LC10]."""
WELSCH_SCALE_DEG = 3.0
"""p of the Welsch estimator, degrees. From [LC10]."""
PATTERN_WEIGHT = 0.1
"""Weight lambda of eq. 2.10. From [LC10]."""
N_REWEIGHTS = 3
"""Reweightings of the samples per round."""
MAX_ITERATIONS = 20
"""Rounds after which the alternation ends."""
MAX_RELATIVE_CHANGE = 1e-3
"""Relative change of the cost below which the alternation ends. Chosen by hand: [LC10] names
none."""


def filter_as_published(
    channels: Channels, frame_rate: float, bases: FilterBases | None, progress: Progress
) -> tuple[Estimate, str]:
    """Filter a take with the patterns of the bases, or with its own; return which were used.

    Takes at a multiple of the bases' frame rate are filtered as interleaved takes at that rate.
    """
    noisy = channels.flat
    base_rate = float(bases.frame_rate) if bases else FilterBasesSettings().frame_rate
    step = max(min(round(frame_rate / base_rate), len(noisy)), 1)
    takes = [noisy[start::step] for start in range(step)]
    patterns, mean, used = _select_patterns(channels, takes, frame_rate, bases)
    values, inliers = noisy.copy(), np.ones_like(noisy)
    iterations, converged = 0, True
    for start, take in enumerate(takes):
        motion, weight, n_needed, has_settled = alternate(take - mean, patterns[:, : len(take)])
        values[start::step], inliers[start::step] = motion + mean, weight
        iterations, converged = max(iterations, n_needed), converged and has_settled
        progress((start + 1) / step, "Filtering")
    deviation = np.where(inliers > 0.5, WELSCH_SCALE_DEG, OFFSET_DEVIATION)
    unknown = np.full_like(values, np.nan)
    return Estimate(values, inliers, deviation, unknown, iterations, converged), used


def alternate(noisy: Array, patterns: Array) -> tuple[Array, Array, int, bool]:
    """Minimize eq. 2.16 of [1]_ by alternating between pattern weights and motion.

    Eq. 2.15 omits the factor 1/2 of the Welsch function (eq. 2.9). It is kept here, so that
    each step lowers the printed cost.

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        Centered; NaN where not observed: the weights alpha of eq. 2.16 are 0 there.
    patterns : shape (n_bases, window, n_channels)

    Returns
    -------
    tuple
        Motion, weights of the estimator, iterations, and whether the cost has converged.

    References
    ----------
    .. [1] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M, section 2.2.
    """
    observed_mask = np.isfinite(noisy)
    observed = np.where(observed_mask, noisy, 0.0)
    motion = fill_channel_gaps(noisy)
    weight, cost, converged, iteration = observed_mask.astype(float), np.inf, False, 0
    while iteration < MAX_ITERATIONS and not converged:
        iteration += 1
        fitted, count = fit_windows(motion, patterns)  # eq. 2.13
        pattern_pull = 2.0 * PATTERN_WEIGHT * count[:, None]
        for _ in range(N_REWEIGHTS):  # eq. 2.15
            weight = observed_mask * np.exp(-(((motion - observed) / WELSCH_SCALE_DEG) ** 2))
            motion = (weight * observed + pattern_pull * fitted) / (weight + pattern_pull)
        before, cost = cost, published_cost(motion, observed, observed_mask, patterns)
        converged = before - cost < MAX_RELATIVE_CHANGE * cost
    return motion, weight, iteration, converged


def fit_windows(motion: Array, patterns: Array) -> tuple[Array, Array]:
    """Project every window on the patterns; return the mean of all, and their number.

    Parameters
    ----------
    motion : shape (n_frames, n_channels)
    patterns : shape (n_bases, window, n_channels), orthonormal

    Returns
    -------
    tuple
        Shapes (n_frames, n_channels) and (n_frames,).
    """
    weights = _pattern_weights(motion, patterns)
    total, count = np.zeros_like(motion), np.zeros(len(motion))
    for offset in range(patterns.shape[1]):
        total[offset : offset + len(weights)] += weights @ patterns[:, offset]
        count[offset : offset + len(weights)] += 1.0
    return total / count[:, None], count


def _pattern_weights(motion: Array, patterns: Array) -> Array:
    """Return the weight of each pattern in each window, shape (n_windows, n_bases).

    It iterates over the frames of the window, so that the windows of a long take are never
    built.
    """
    n_bases, window, _ = patterns.shape
    weights = np.zeros((len(motion) - window + 1, n_bases))
    for offset in range(window):
        weights += motion[offset : offset + len(weights)] @ patterns[:, offset].T
    return weights


def published_cost(
    motion: Array, observed: Array, observed_mask: Array, patterns: Array
) -> float:
    """Return eq. 2.16 with the best pattern weights; both motions are centered.

    Parameters
    ----------
    motion, observed, observed_mask : shape (n_frames, n_channels)
    patterns : shape (n_patterns, length, n_channels)
    """
    weights = _pattern_weights(motion, patterns)
    frame_power = (motion**2).sum(axis=1)
    in_windows = sum(
        float(frame_power[offset : offset + len(weights)].sum())
        for offset in range(patterns.shape[1])
    )
    outside = in_windows - (weights**2).sum()
    robust = (
        WELSCH_SCALE_DEG**2 / 2 * (1 - np.exp(-(((motion - observed) / WELSCH_SCALE_DEG) ** 2)))
    )
    return float((observed_mask * robust).sum() + PATTERN_WEIGHT * outside)


def _select_patterns(
    channels: Channels, takes: list[Array], frame_rate: float, bases: FilterBases | None
) -> tuple[Array, Array, str]:
    """Return patterns of the take's channels, their mean, and their source."""
    reason = _reason_against(channels, takes, bases)
    if bases is not None and not reason:
        offset = {str(key): part for part, key in enumerate(bases.keys)}
        columns = np.concatenate([3 * offset[key] + np.arange(3) for key in channels.keys])
        n_clips = int(bases.n_clips)
        clips = "1 example clip" if n_clips == 1 else f"{n_clips} example clips"
        message = f"Patterns of {clips}."
        return bases.vectors[:, :, columns], bases.mean[columns], message
    despiked = [fill_channel_gaps(remove_outliers(take, 4)) for take in takes]
    mean = np.concatenate(despiked).mean(axis=0)
    window = min(FilterBasesSettings().n_frames, len(takes[-1]))
    products = LagProducts(len(mean), window)
    for take in despiked:
        products.add(take - mean)
    _, vectors = find_leading_eigenpairs(products.total(), KEPT_ENERGY)
    patterns = vectors.T.reshape(-1, window, len(mean))
    return patterns, mean, f"The take's own patterns: {reason}."


def _reason_against(channels: Channels, takes: list[Array], bases: FilterBases | None) -> str:
    """Return why this method cannot use the bases; nothing if it can."""
    if bases is None:
        return "no examples were given"
    n_missing = len(set(channels.keys) - set(map(str, bases.keys)))
    if n_missing:
        joints = "one joint" if n_missing == 1 else f"{n_missing} joints"
        return f"the examples lack {joints} of the take; all are required"
    if len(takes[-1]) < bases.window:
        return "the take is shorter than the example patterns"
    return ""
