"""The default method: the posterior of all windows under a prior that adapts to the take."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress, unwatched
from .denoise_estimate import Estimate
from .denoise_filters import Filter, filters_of, variance_of, weight_of
from .denoise_gaps import gap_patterns, long_gaps
from .denoise_windows import Windows
from .noise import alike
from .prior import WavePrior
from .quick_moves import quick_moves

Array = NDArray[np.float64]

OUTLIER_DENSITY = 1.0 / 120.0
"""Of an outlier's error, per degree or centimetre: anything within +-60 is as likely."""
BLOCK = 512
"""Windows worked on at a time: this bounds the memory, however long the take."""
SMALL_ERROR = 0.5
"""Degrees or centimetres: nothing so near to the estimate is called an outlier."""
FIRST_OUTLIERS = 0.03
MOST_OUTLIERS = 0.6
MAX_ITERATIONS = 30
ADAPTATIONS = 5
"""Iterations in which the prior still adapts to the take."""
SETTLED = 0.02
"""Root mean square change, degrees or centimetres, below which the estimate is settled."""
FEW = 4
"""Patterns of gaps that are solved for again whenever the prior adapts."""
MOST_LEVERAGE = 0.98
FAR = 4.0
"""Errors beyond so many standard deviations of the noise all count the same."""
NOISE_BOUNDS = (0.5, 1.1)
"""Range, relative to the first guess, in which the noise is estimated."""


@dataclass(eq=False)
class Sweep:
    """What one pass over all windows adds up."""

    total: Array
    """Tapered posterior means, shape (n_frames, n_channels)."""
    slow_moment: Array
    """Mean second moment of the slow waves, a square matrix."""
    fast_power: Array
    """Mean square of the measured fast waves, shape (length - n_slow, n_channels)."""


def estimate_channels(
    noisy: Array,
    start: Array,
    noise: Array,
    prior: WavePrior,
    windows: Windows,
    progress: Progress = unwatched,
    *,
    at_most: int = MAX_ITERATIONS,
) -> Estimate:
    """Alternate between outlier weights, the posterior of all windows, and what they tell.

    Each round: every sample gets its probability of being no outlier; samples are drawn towards
    the estimate by what is missing to certainty; every window takes its posterior mean given
    its neighbours in time and all other channels; the noise of each channel, the share of
    outliers and the covariance are estimated again (expectation maximisation).

    Parameters
    ----------
    noisy : shape (n_frames, n_channels)
        NaN where not observed.
    start : same shape, without NaN
    noise : shape (n_channels,)
        First guess of the standard deviation.
    prior : WavePrior
    windows : Windows
    progress : Progress
    at_most : int
        Iterations.
    """
    prior = prior.at_most(windows.length)
    known, observed = np.isfinite(noisy), np.nan_to_num(noisy)
    patterns = gap_patterns(known, windows, prior.n_slow)
    first_guess, estimate = noise, start
    slow, fast = prior.matrix, _extended(prior.fast, windows.length - prior.n_slow)
    weight, variance = known.astype(float), np.zeros_like(noisy)
    total_weight, filters = weight_of(patterns, windows), list[Filter]()
    rate, iteration, change = FIRST_OUTLIERS, 0, np.inf
    while iteration < at_most and change > SETTLED:
        progress(iteration / at_most, "Denoising")
        believed = _believed(observed - estimate, known, weight, variance, noise, rate)
        # Halfway, lest a sample that is judged by its own estimate goes in and out for ever.
        weight = believed if iteration <= ADAPTATIONS else 0.5 * (weight + believed)
        rate = _outlier_rate(weight, known)
        adapts = iteration < ADAPTATIONS
        if iteration <= ADAPTATIONS:  # from then on nothing changes that they are made of
            stale = filters if adapts and len(patterns) > FEW else []
            filters = filters_of(
                patterns, slow, fast, noise, prior.caution, windows, stale=stale
            )
            variance = variance_of(filters, windows, noisy)
        drawn = estimate + weight * (observed - estimate) - prior.mean
        sweep = _swept(drawn, filters, windows, with_moments=adapts)
        before, estimate = estimate, sweep.total / total_weight + prior.mean
        change = np.inf if adapts else float(np.sqrt(np.mean((estimate - before) ** 2)))
        if adapts:
            slow, fast = _adapted(prior, sweep, filters[0].gains.noise)
            noise = _noise(observed - estimate, weight, variance, first_guess)
        iteration += 1
    alone = 1.0 / (1.0 - np.minimum(variance / noise**2, MOST_LEVERAGE))
    foretold = np.where(known, (observed - estimate) * alone, np.nan)
    alone[long_gaps(known, windows.long_gap)] = 1.0  # where the variance is without the sample
    return Estimate(
        estimate,
        weight,
        np.sqrt(variance * (weight + (1.0 - weight) * alone)),
        _foresight(foretold, first_guess),
        iteration,
        change <= SETTLED,
    )


def _outlier_rate(weight: Array, known: NDArray[np.bool_]) -> float:
    inside = float(weight[known].mean()) if known.any() else 1.0
    return float(np.clip(1.0 - inside, 1e-4, MOST_OUTLIERS))


def _foresight(error: Array, noise: Array) -> float:
    """Return the mean square of errors of samples that had no part in their own estimate.

    For a linear filter these are the errors divided by one less the leverage, which is the
    posterior variance over that of the noise. NaN where not observed.
    """
    square = np.minimum((error / (FAR * noise)) ** 2, 1.0)
    known = np.isfinite(square)
    return float(square[known].mean()) if known.any() else 0.0


def _believed(
    error: Array,
    known: NDArray[np.bool_],
    weight: Array,
    variance: Array,
    noise: Array,
    rate: float,
) -> Array:
    """Return each sample's probability of being no outlier; quick moves are none."""
    inside = _inlier_probability(error, weight, variance, noise, rate)
    quick = quick_moves(np.where(known, error, np.nan), inside, noise, rate)
    return np.asarray(known * np.where(quick, 1.0, inside))


def _inlier_probability(
    error: Array, weight: Array, variance: Array, noise: Array, rate: float
) -> Array:
    """Weigh noise around what all other samples foretell against an outlier."""
    alone = 1.0 / (1.0 - np.minimum(variance / noise**2, MOST_LEVERAGE))
    foretold = error * (weight * alone + 1.0 - weight)
    spread = noise**2 + variance * alone + SMALL_ERROR**2
    inside = np.exp(-0.5 * foretold**2 / spread) / np.sqrt(2 * np.pi * spread)
    inside *= 1.0 - rate
    return np.asarray(inside / (inside + rate * OUTLIER_DENSITY))


def _swept(drawn: Array, filters: list[Filter], windows: Windows, with_moments: bool) -> Sweep:
    """Filter every window; sum windows and, where asked for, second moments."""
    n_channels = drawn.shape[1]
    size, n_slow = len(filters[0].gains.slow), len(filters[0].gains.slow) // n_channels
    sweep = Sweep(
        np.zeros_like(drawn), np.zeros((size, size)), np.zeros_like(filters[0].gains.fast)
    )
    for one in filters:
        scale = np.tile(one.gains.noise, n_slow)
        for first in range(0, len(one.pattern.starts), BLOCK):
            starts = one.pattern.starts[first : first + BLOCK]
            frames = windows.cut(drawn, starts)
            waves = windows.waves_of(frames)
            seen = windows.waves_of(one.pattern.observed(frames)) if one.gaps else waves
            slow = seen[:, :n_slow].reshape(-1, size) / scale
            slow = (
                one.gaps.mean(slow, one.pattern.places) if one.gaps else slow @ one.gains.slow
            )
            slow *= scale
            if with_moments:
                sweep.slow_moment += slow.T @ slow
                sweep.fast_power += (waves[:, n_slow:] ** 2).sum(axis=0)
            waves[:, :n_slow] = slow.reshape(-1, n_slow, n_channels)
            waves[:, n_slow:] *= one.gains.fast
            windows.add(sweep.total, windows.frames_of(waves), starts)
        if with_moments:
            one.add_covariance(sweep.slow_moment)
    n_windows = sum(len(one.pattern.starts) for one in filters)
    sweep.slow_moment /= n_windows
    sweep.fast_power /= n_windows
    return sweep


def _adapted(prior: WavePrior, sweep: Sweep, noise: Array) -> tuple[Array, Array]:
    """Mix the prior's covariance with that of the take, as it is estimated so far.

    A channel's covariance with itself takes few frames to learn, that with others takes many:
    each has its own share.
    """
    n_slow, n_channels = prior.n_slow, len(prior.mean)
    moment = sweep.slow_moment
    together, alone = prior.trust, prior.trust_alone
    own, rest = (
        np.tile(np.sqrt(together), n_slow),
        np.tile(np.sqrt(1 - together - alone), n_slow),
    )
    slow = prior.matrix * np.outer(rest, rest) + moment * np.outer(own, own)
    blocks = slow.reshape(n_slow, n_channels, n_slow, n_channels)
    channels = np.arange(n_channels)
    moments = moment.reshape(blocks.shape)[:, channels, :, channels]
    blocks[:, channels, :, channels] += moments * alone[:, None, None]
    power = np.maximum(sweep.fast_power - noise**2, 0.0)
    fast = _extended(prior.fast, len(power))
    return slow, fast * (1.0 - together - alone) + power * (together + alone)


def _noise(error: Array, weight: Array, variance: Array, first_guess: Array) -> Array:
    """Return the noise of each channel, from what the estimate leaves over."""
    total = weight.sum(axis=0)
    square = (weight * (error**2 + variance)).sum(axis=0) / np.maximum(total, 1e-9)
    noise = np.where(total > 0.0, np.sqrt(square), first_guess)
    noise = np.sqrt(
        first_guess
        * np.clip(noise, NOISE_BOUNDS[0] * first_guess, NOISE_BOUNDS[1] * first_guess)
    )
    return alike(noise, total)


def _extended(fast: Array, n_waves: int) -> Array:
    """Return the variances of more (or fewer) fast waves; those unheard of fade away."""
    if len(fast) >= n_waves:
        return fast[:n_waves]
    last = fast[-1:] if len(fast) else np.zeros((1, fast.shape[1]))
    steps = np.arange(1, n_waves - len(fast) + 1)[:, None]
    return np.concatenate([fast, last / (1.0 + steps / max(len(fast), 1)) ** 4])
