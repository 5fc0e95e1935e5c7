"""The default method: the posterior of all windows under a prior that adapts to the take."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress, unwatched
from ...signals import alike
from ..prior import WavePrior
from .covariance import adapted, expected
from .estimate import Estimate
from .fast_motion import quick_moves
from .filters import Filter, filters_of, variance_of, weight_of
from .gap_patterns import gap_patterns, long_gaps
from .joint_outliers import WholeJoints
from .smoothness import fit_smoothness
from .filter_pass import swept
from .windows import Windows

Array = NDArray[np.float64]

OUTLIER_DENSITY = 1.0 / 120.0
"""Of an outlier's error, per degree or centimetre: anything within +-60 is as likely."""
SMALL_ERROR = 0.5
"""Degrees or centimetres: nothing so near to the estimate is called an outlier."""
FIRST_OUTLIERS = 0.03
MOST_OUTLIERS = 0.6
MAX_ITERATIONS = 30
ADAPTATIONS = 5
"""Iterations in which the prior still adapts to the take."""
SETTLED = 0.01
"""Root mean square change, degrees or centimetres, below which the estimate is settled."""
LOOKS = (8.0, 4.0, 2.0)
"""Times the noise that the first rounds take it for."""
FEW = 4
"""Patterns of gaps that are solved for again whenever the prior adapts."""
MOST_LEVERAGE = 0.98
FARTHEST, BEYOND = 4.0, 0.5
"""How far an estimate may leave what was seen: in standard deviations of the prior, or in
extents of what was seen."""
NOISE_BOUNDS = (0.5, 1.1)
"""Range, relative to the first guess, in which the noise is estimated."""


def estimate_channels(
    noisy: Array,
    start: Array,
    noise: Array,
    prior: WavePrior,
    windows: Windows,
    progress: Progress = unwatched,
    *,
    joints: WholeJoints | None = None,
    looks: Sequence[float] = LOOKS,
    at_most: int = MAX_ITERATIONS,
) -> Estimate:
    """Alternate between outlier weights, the posterior of all windows, and what they tell.

    Each round: every sample gets its probability of being no outlier; samples are drawn towards
    the estimate by what is missing to certainty; every window takes its posterior mean given
    its neighbours in time and all other channels; the noise of each channel, the share of
    outliers and the covariance are estimated again (expectation maximisation).

    The first rounds, the `looks`, take the noise for much greater than it is, ever less: they
    lean on what is far in time and on the other channels. Else what is wrong for several frames
    is followed before it can be known for an outlier.

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
    joints : WholeJoints, optional
        Which channels are apt to be wrong together.
    looks : sequence of float
        How many times greater the noise is taken in each.
    at_most : int
        Iterations after them.
    """
    rounds = _Rounds(noisy, start, noise, prior, windows.fewer, joints)
    n_looks, n_rounds = len(looks), len(looks) + at_most
    for look, times in enumerate(looks):
        progress(look / n_rounds, "Denoising")
        rounds.believe()
        rounds.tune(times)
        rounds.filter()
    iteration, change = 0, np.inf
    while iteration < at_most and change > SETTLED:
        progress((n_looks + iteration) / n_rounds, "Denoising")
        adapts = iteration < ADAPTATIONS
        # Halfway, lest a sample that is judged by its own estimate goes in and out for ever.
        rounds.believe(1.0 if iteration <= ADAPTATIONS else 0.5)
        if iteration == 0:
            rounds.fit()
        if iteration == ADAPTATIONS:
            rounds.use(windows)
        if iteration <= ADAPTATIONS:
            rounds.tune(nearly=adapts and iteration > 0)
        moved = rounds.filter(adapts=adapts)
        change = np.inf if adapts else moved
        iteration += 1
    return rounds.estimated(iteration, change <= SETTLED)


class _Rounds:
    """What is believed of a take, from round to round: `believe`, `tune`, `filter`."""

    def __init__(
        self,
        noisy: Array,
        start: Array,
        noise: Array,
        prior: WavePrior,
        windows: Windows,
        joints: WholeJoints | None,
    ) -> None:
        self.known, self.observed = np.isfinite(noisy), np.nan_to_num(noisy)
        self.joints, self.prior = joints, prior.at_most(windows.length)
        self.use(windows)
        self.estimate, self.mean = start, prior.mean
        self.bounds = _bounds(start, prior)
        self.first_guess = self.noise = noise
        self.covariance = expected(self.prior, windows.length)
        self.filters = list[Filter]()
        self.weight, self.rate = self.known.astype(float), FIRST_OUTLIERS
        self.variance = np.zeros_like(noisy)
        self.alone = np.ones_like(noisy)
        """Variance without the sample over that with it, `variance`."""

    def use(self, windows: Windows) -> None:
        """Cut the take into these windows."""
        self.windows = windows
        self.patterns = gap_patterns(self.known, windows, self.prior.n_slow)
        self.total_weight = weight_of(self.patterns, windows)

    def believe(self, step: float = 1.0) -> None:
        """Go this part of the way to each sample's probability of being no outlier."""
        error = self.observed - self.estimate
        foretold = error * (self.weight * self.alone + 1.0 - self.weight)
        spread = self.noise**2 + self.variance * self.alone + SMALL_ERROR**2
        rates: float | Array = self.rate
        if self.joints is not None:
            rates = self.joints.rates(self.known * (1.0 - self.weight), self.known, self.rate)
        inside = _inlier_probability(foretold, spread, rates)
        quick = quick_moves(
            np.where(self.known, error, np.nan), inside, self.noise, self.rate,
            self.windows.length,
        )  # fmt: skip
        believed = self.known * np.where(quick, 1.0, inside)
        self.weight = self.weight + step * (believed - self.weight)
        outside = 1.0 - float(self.weight[self.known].mean()) if self.known.any() else 0.0
        self.rate = float(np.clip(outside, 1e-4, MOST_OUTLIERS))

    def tune(self, times: float = 1.0, *, nearly: bool = False) -> None:
        """Make the filters for the noise, taken so many times greater.

        With `nearly`, filters of windows with gaps may stay as they are: they are costly.
        """
        noise = times * self.noise
        self.filters = filters_of(
            self.patterns, self.covariance, noise, self.prior.caution, self.windows,
            stale=self.filters if nearly and len(self.patterns) > FEW else [],
        )  # fmt: skip
        self.variance, leverage = variance_of(self.filters, self.windows, self.observed)
        self.alone = 1.0 / (1.0 - np.minimum(leverage, MOST_LEVERAGE))

    def fit(self) -> None:
        """Fit how fast the channels move to what is believed of them."""
        drawn = self.estimate + self.weight * (self.observed - self.estimate) - self.mean
        noise = self.noise * np.sqrt(self.weight.mean(axis=0))
        found = fit_smoothness(drawn, noise, self.prior.smooth.kernels, self.windows)
        seen = self.known.mean(axis=0)
        weights = seen * found + (1.0 - seen) * self.prior.smooth.weights
        self.prior = self.prior.with_smoothness(weights)
        self.covariance = expected(self.prior, self.windows.length)

    def filter(self, *, adapts: bool = False) -> float:
        """Estimate again, and how noise and prior are; return the root mean square change."""
        drawn = self.estimate + self.weight * (self.observed - self.estimate) - self.mean
        sweep = swept(drawn, self.filters, self.windows, with_moments=adapts)
        # Where nearly all is missing, windows that lean on each other can drift without end.
        found = sweep.total / self.total_weight + self.mean
        before, self.estimate = self.estimate, np.clip(found, *self.bounds)
        if adapts:
            shift = self.estimate.mean(axis=0) - self.mean
            self.mean = self.mean + self.prior.follows * shift
            wave_noise = self.noise / np.sqrt(self.windows.density)
            self.covariance = adapted(
                self.prior, sweep.slow_moment, sweep.fast_power, wave_noise
            )
            error = self.observed - self.estimate
            self.noise = _noise(error, self.weight, self.variance, self.first_guess)
        return float(np.sqrt(np.mean((self.estimate - before) ** 2)))

    def estimated(self, iterations: int, converged: bool) -> Estimate:
        """Return the estimate, and how sure it is."""
        error = np.where(self.known, self.observed - self.estimate, np.nan)
        # In long gaps the variance is without the sample.
        alone = np.where(long_gaps(self.known, self.windows.long_gap), 1.0, self.alone)
        variance = self.variance * (self.weight + (1.0 - self.weight) * alone)
        return Estimate(
            self.estimate,
            self.weight,
            np.sqrt(variance),
            error * self.alone,
            iterations,
            converged,
        )


def _bounds(start: Array, prior: WavePrior) -> tuple[Array, Array]:
    """Return how low and how high each channel may be estimated, shape (n_channels,)."""
    low = np.minimum(start.min(axis=0), prior.mean)
    high = np.maximum(start.max(axis=0), prior.mean)
    reach = np.maximum(BEYOND * (high - low), FARTHEST * prior.deviation)
    return low - reach, high + reach


def _inlier_probability(error: Array, spread: Array, rate: float | Array) -> Array:
    """Weigh noise around what all other samples foretell against an outlier."""
    inside = np.exp(-0.5 * error**2 / spread) / np.sqrt(2 * np.pi * spread)
    inside *= 1.0 - rate
    return np.asarray(inside / (inside + rate * OUTLIER_DENSITY))


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
