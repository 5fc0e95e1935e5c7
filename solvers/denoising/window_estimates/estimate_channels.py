"""Compute the posterior of all windows under a prior that adapts to the take."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...progress import Progress, unwatched
from ...signals import DIFFERENCE_ORDER, shrink_noise
from ..averaging import MIN_NOISE
from ..channels import Estimate
from ..outliers import (
    MIN_OUTLIER_RATE,
    compute_inlier_probability,
    fit_inlier_probability,
    outlier_rate,
)
from ..window_priors import WindowPrior, Windows
from .covariance import adapt_covariance, covariance_from_prior
from .filter_pass import filter_windows
from .filters import Filter, build_filters, compute_variance, sum_window_weights
from .gap_patterns import find_gap_patterns, find_long_gaps
from .rough_take import RoughTake
from .smoothness import fit_smoothness

MAX_ITERATIONS = 30
"""Iterations after which the estimate ends unconverged. It bounds the run time."""
N_ADAPTATIONS = 5
"""Iterations in which the prior still adapts to the take. Chosen by hand; `make sensitivity`
varies it."""
MAX_SETTLED_CHANGE = 0.01
"""Root mean square change, degrees or centimeters, below which the estimate has converged.
Chosen by hand; `make sensitivity` varies it."""
MAX_UNREPORTED_CHANGE = 0.1
"""Root mean square change, degrees or centimeters, of the last iteration, above which the
estimate is reported as unconverged. Chosen by hand: less is not visible. In 30 iterations, fast
takes come down to 0.02."""
NOISE_FACTORS = (8.0, 4.0, 2.0)
"""Factors by which the first rounds inflate the noise. Chosen by hand; `make sensitivity`
varies it."""
MAX_LEVERAGE = 0.98
"""Largest fraction of its own weight in an estimate that a sample is corrected for. Sweep: a
limit of 0.99998 gains 0.1 %, one of 0.8 costs 0.1 %; 1 divides by zero."""
FIRST_NOISE_WEIGHT = 0.5
"""Weight of the first estimate of the noise in a take without outliers, relative to one: by
definition, that of a mean of two estimates."""


def estimate_channels(
    take: RoughTake,
    prior: WindowPrior,
    progress: Progress = unwatched,
    *,
    noise_factors: Sequence[float] = NOISE_FACTORS,
    max_iterations: int = MAX_ITERATIONS,
) -> Estimate:
    """Alternate between outlier weights, the posterior of all windows, and their statistics.

    Each round has three steps (expectation maximization). Every sample gets its probability of
    being no outlier, and moves toward the estimate by the probability of being one. Every
    window takes its posterior mean given its neighbors in time and all other channels. The
    noise of each channel, the fraction of outliers and the covariance are estimated again.

    The first rounds inflate the noise by the `noise_factors`, in descending order. They rely on
    samples distant in time and on the other channels. Otherwise the estimate would follow an
    error of several frames before it is recognized as an outlier.

    Parameters
    ----------
    take : RoughTake
        Where the alternation starts.
    prior : WindowPrior
    progress : Progress
    noise_factors : sequence of float
        Inflation of the noise, one for each of the first rounds.
    max_iterations : int
        Iterations after them.
    """
    state = _PosteriorState(take, prior)
    n_first_rounds, n_rounds = len(noise_factors), len(noise_factors) + max_iterations
    for index, factor in enumerate(noise_factors):
        progress(index / n_rounds, "Denoising")
        state.update_outliers()
        state.update_filters(factor)
        state.update_estimate()
    iteration, change, last_change = 0, np.inf, np.inf
    while iteration < max_iterations and change > MAX_SETTLED_CHANGE:
        progress((n_first_rounds + iteration) / n_rounds, "Denoising")
        adapts = iteration < N_ADAPTATIONS
        # A half step: otherwise samples near the threshold oscillate.
        state.update_outliers(1.0 if iteration <= N_ADAPTATIONS else 0.5)
        if iteration == 0:
            state.update_smoothness()
        if iteration == N_ADAPTATIONS:
            state.set_windows(take.windows)
        if iteration <= N_ADAPTATIONS:
            state.update_filters(reuse_gapped=adapts and iteration > 0)
        last_change = state.update_estimate(adapts=adapts)
        change = np.inf if adapts else last_change
        iteration += 1
    return state.result(iteration, last_change <= MAX_UNREPORTED_CHANGE)


class _PosteriorState:
    """The state of the alternation: weights, noise, covariance, filters and estimate."""

    def __init__(self, take: RoughTake, prior: WindowPrior) -> None:
        self.observed, self.samples = np.isfinite(take.noisy), np.nan_to_num(take.noisy)
        self.prior = prior.in_windows(take.windows)
        self.set_windows(take.windows.with_less_overlap)
        self.estimate, self.mean = take.values, prior.mean
        self.first_noise = self.noise = take.noise
        self.covariance = covariance_from_prior(self.prior, take.windows.length)
        self.filters = list[Filter]()
        self.may_be_right = self.observed & ~take.is_error
        self.weight, self.rate = self.may_be_right.astype(float), MIN_OUTLIER_RATE
        self.variance = np.zeros_like(take.noisy)
        self.leave_one_out_ratio = np.ones_like(take.noisy)
        """Variance without the sample, relative to `variance`, the variance with it."""

    def set_windows(self, windows: Windows) -> None:
        """Split the take into these windows."""
        self.windows = windows
        self.patterns = find_gap_patterns(self.observed, windows, self.prior.n_slow)
        self.total_weight = sum_window_weights(self.patterns, windows)

    def update_outliers(self, step: float = 1.0) -> None:
        """Move the weights by this step toward the probability of being no outlier."""
        error, variance = self._prediction_error()
        inlier_probability = compute_inlier_probability(
            error, self.noise**2 + variance, self.rate
        )
        target_weight = self.may_be_right * inlier_probability
        self.weight = self.weight + step * (target_weight - self.weight)
        self.rate = outlier_rate(self.weight, self.observed)

    def update_filters(self, factor: float = 1.0, *, reuse_gapped: bool = False) -> None:
        """Build the filters for the noise, inflated by this factor.

        With `reuse_gapped`, filters of windows with gaps may stay the same: they are expensive.
        """
        noise = factor * self.noise
        self.filters = build_filters(
            self.patterns, self.covariance, noise, self.prior.decoupling, self.windows,
            reusable=self.filters if reuse_gapped else [],
        )  # fmt: skip
        self.variance, leverage = compute_variance(self.filters, self.windows, self.samples)
        self.leave_one_out_ratio = 1.0 / (1.0 - np.minimum(leverage, MAX_LEVERAGE))

    def update_smoothness(self) -> None:
        """Fit the correlation times of the channels to the current estimate."""
        blended = self.estimate + self.weight * (self.samples - self.estimate) - self.mean
        noise = self.noise * np.sqrt(self.weight.mean(axis=0))
        new_values = fit_smoothness(blended, noise, self.prior.smooth.kernels, self.windows)
        observed_fraction = self.observed.mean(axis=0)
        weights = (
            observed_fraction * new_values
            + (1.0 - observed_fraction) * self.prior.smooth.weights
        )
        self.prior = self.prior.with_smoothness(weights)
        self.covariance = covariance_from_prior(self.prior, self.windows.length)

    def update_estimate(self, *, adapts: bool = False) -> float:
        """Update the estimate, noise and prior; return the root mean square change."""
        blended = self.estimate + self.weight * (self.samples - self.estimate) - self.mean
        filtered = filter_windows(blended, self.filters, self.windows, with_moments=adapts)
        before = self.estimate
        self.estimate = filtered.total / self.total_weight + self.mean
        if adapts:
            shift = self.estimate.mean(axis=0) - self.mean
            self.mean = self.mean + self.prior.mean_adaptation * shift
            coefficient_noise = self.noise / np.sqrt(self.windows.density)
            self.covariance = adapt_covariance(
                self.prior, filtered.slow_moment, filtered.fast_power, coefficient_noise
            )
            self._update_noise()
        return float(np.sqrt(np.mean((self.estimate - before) ** 2)))

    def _prediction_error(self) -> tuple[Array, Array]:
        """Return the errors of predictions by all other samples, and their variance."""
        error = self.samples - self.estimate
        return (
            error * (self.weight * self.leave_one_out_ratio + 1.0 - self.weight),
            self.variance * self.leave_one_out_ratio,
        )

    def _update_noise(self) -> None:
        """Estimate the noise of each channel from the residuals of the estimate.

        The mean, of logarithms, with the first estimate: the more a take has outliers, the less
        the first one counts, since each of its differences needs several right samples.
        """
        inliers = fit_inlier_probability(
            *self._prediction_error(), self.may_be_right, self.rate
        )
        total = inliers.sum(axis=0)
        error = self.samples - self.estimate
        square = (inliers * (error**2 + self.variance)).sum(axis=0) / np.maximum(total, 1e-9)
        noise = np.where(total > 0.0, np.sqrt(square), self.first_noise)
        right = 1.0 - outlier_rate(inliers, self.may_be_right)
        weight = FIRST_NOISE_WEIGHT * right ** (DIFFERENCE_ORDER + 1)
        noise = self.first_noise**weight * np.maximum(noise, MIN_NOISE) ** (1.0 - weight)
        self.noise = shrink_noise(noise, total)

    def result(self, iterations: int, converged: bool) -> Estimate:
        """Return the estimate with its standard deviation."""
        error = np.where(self.observed, self.samples - self.estimate, np.nan)
        # In long gaps the variance already excludes the sample.
        leave_one_out_ratio = np.where(
            find_long_gaps(self.observed, self.windows.long_gap), 1.0, self.leave_one_out_ratio
        )
        variance = self.variance * (self.weight + (1.0 - self.weight) * leave_one_out_ratio)
        return Estimate(
            self.estimate,
            self.weight,
            np.sqrt(variance),
            error * self.leave_one_out_ratio,
            iterations,
            converged,
        )
