"""The prior of a window: a Gaussian over its DCT coefficients.

A window is represented by the discrete cosine transform (DCT) of each channel. The low
frequencies are called slow coefficients, the others fast.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from .windows import Windows

SLOW_FRACTION = 0.6
"""Fraction of the coefficients, slowest first, with a joint covariance; faster ones are
independent. Half is worse (`make sensitivity`), and twice is no fraction."""


@dataclass(frozen=True, eq=False)
class SmoothPrior:
    """Prior of channels with known variance and smoothness only."""

    kernels: Array
    """Covariance of the coefficients at each correlation time, shape (n_kernels,
    n_coefficients, n_coefficients)."""
    weights: Array
    """Variance of each channel at each correlation time, shape (n_kernels, n_channels)."""
    fraction: float = 1.0
    """Weight of this prior in the mixture that contains it."""

    def slow(self, n_slow: int) -> Array:
        """Return covariances of slow coefficients, shape (n_channels, n_slow, n_slow)."""
        slow_kernels = self.kernels[:, :n_slow, :n_slow]
        return np.asarray(np.einsum("lc,lkj->ckj", self.weights, slow_kernels))

    def fast(self, n_slow: int) -> Array:
        """Return variances of the fast coefficients, (n_coefficients - n_slow, n_channels)."""
        variances = np.einsum("lkk->kl", self.kernels)[n_slow:]
        return np.asarray(variances @ self.weights)


@dataclass(frozen=True, eq=False)
class WindowPrior:
    """A Gaussian over the DCT coefficients of a window of all channels.

    Attributes
    ----------
    mean : shape (n_channels,)
        Constant over the window.
    slow : shape (n_slow, n_channels, n_slow, n_channels)
        Covariance of the slow coefficients.
    fast : shape (n_coefficients - n_slow, n_channels)
        Variances of the fast coefficients, independent of all others.
    own_weight : float
        Weight of the take's own covariance in the estimate, 0 to 1. Channels in the examples
        need less of it than others.
    own_weight_in_gaps : float
        The same where channels have long gaps; other channels of the same body fill them best.
    mean_adaptation : shape (n_channels,)
        Weight of the take's own mean in the mean, as the estimate improves.
    """

    mean: Array
    slow: Array
    fast: Array
    own_weight: float
    own_weight_in_gaps: float
    mean_adaptation: Array
    smooth: SmoothPrior
    """The part of the covariance that is fitted to the take."""
    decoupling: float = 0.5
    """Degree of independence of channels where one of them has a long gap, 0 to 1."""

    @property
    def n_slow(self) -> int:
        """Number of slow coefficients."""
        return len(self.slow)

    def in_windows(self, windows: Windows) -> "WindowPrior":
        """Return the prior of at most as many coefficients as these windows have, in their
        units."""
        units = windows.noise_deviations[: self.smooth.kernels.shape[1]]
        slow, fast = units[: self.n_slow], units[self.n_slow :]
        kernels = self.smooth.kernels[:, : len(units), : len(units)] / np.outer(units, units)
        of_slow = self.slow[: len(slow), :, : len(slow)]
        return replace(
            self,
            slow=of_slow / slow[:, None, None, None] / slow[:, None],
            fast=self.fast[: len(fast)] / np.square(fast)[:, None],
            smooth=replace(self.smooth, kernels=kernels),
        )

    def select_channels(self, channels: NDArray[np.intp]) -> "WindowPrior":
        """Return the prior of some of the channels."""
        return replace(
            self,
            mean=self.mean[channels],
            slow=self.slow[:, channels][:, :, :, channels],
            fast=self.fast[:, channels],
            mean_adaptation=self.mean_adaptation[channels],
            smooth=replace(self.smooth, weights=self.smooth.weights[:, channels]),
        )

    def with_smoothness(self, weights: Array) -> "WindowPrior":
        """Return the prior with other variances, (n_correlation_times, n_channels)."""
        change = replace(self.smooth, weights=weights - self.smooth.weights)
        slow, channels, fraction = self.slow.copy(), np.arange(len(self.mean)), change.fraction
        slow[:, channels, :, channels] += fraction * change.slow(self.n_slow)
        fast = self.fast + fraction * change.fast(self.n_slow)
        return replace(self, slow=slow, fast=fast, smooth=replace(self.smooth, weights=weights))

    @property
    def matrix(self) -> Array:
        """Covariance of the slow coefficients as a square matrix, coefficients outermost."""
        size = self.n_slow * len(self.mean)
        return self.slow.reshape(size, size)


def count_slow_coefficients(window: int) -> int:
    """Return the number of slow coefficients of a window."""
    return max(round(SLOW_FRACTION * window), 1)


def build_smooth_prior(
    mean: Array, smooth: SmoothPrior, own_weight: float, own_weight_in_gaps: float
) -> WindowPrior:
    """Return the prior of channels of this mean, (n_channels,), that are only smooth."""
    n_slow, channels = count_slow_coefficients(smooth.kernels.shape[1]), np.arange(len(mean))
    slow = np.zeros((n_slow, len(mean), n_slow, len(mean)))
    slow[:, channels, :, channels] = smooth.slow(n_slow)
    fast, adaptation = smooth.fast(n_slow), np.zeros(len(mean))
    return WindowPrior(mean, slow, fast, own_weight, own_weight_in_gaps, adaptation, smooth)


def mix_priors(examples: WindowPrior, own: WindowPrior, fraction: float) -> WindowPrior:
    """Return the examples' prior mixed with a fraction of the smooth one."""
    return replace(
        examples,
        slow=(1.0 - fraction) * examples.slow + fraction * own.slow,
        fast=(1.0 - fraction) * examples.fast + fraction * own.fast,
        smooth=replace(own.smooth, fraction=fraction),
    )
