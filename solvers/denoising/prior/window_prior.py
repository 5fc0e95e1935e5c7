"""What is expected of a window before the take is seen: a Gaussian over its waves."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SLOW_FRACTION = 0.6
"""Share of the waves, slowest first, that are told together; faster ones are independent."""
FAST_VARIANCE_FLOOR = 1e-4
"""Variance, relative to a channel's own, that any fast wave may have."""


@dataclass(frozen=True, eq=False)
class SmoothPrior:
    """What is expected of channels of which only variance and smoothness are known."""

    kernels: Array
    """Covariances of waves at each correlation time, shape (n_kernels, n_waves, n_waves)."""
    weights: Array
    """Variance of each channel at each correlation time, shape (n_kernels, n_channels)."""
    fraction: float = 1.0
    """Of it in the prior that it is part of."""

    def slow(self, n_slow: int) -> Array:
        """Return covariances of slow waves, shape (n_channels, n_slow, n_slow)."""
        slow_kernels = self.kernels[:, :n_slow, :n_slow]
        return np.asarray(np.einsum("lc,lkj->ckj", self.weights, slow_kernels))

    def fast(self, n_slow: int) -> Array:
        """Return variances of the other waves, shape (n_waves - n_slow, n_channels)."""
        variances = np.einsum("lkk->kl", self.kernels)[n_slow:] + FAST_VARIANCE_FLOOR
        return np.asarray(variances @ self.weights)


@dataclass(frozen=True, eq=False)
class WindowPrior:
    """A Gaussian over the waves of a window of all channels.

    Attributes
    ----------
    mean : shape (n_channels,)
        Constant over the window.
    slow : shape (n_slow, n_channels, n_slow, n_channels)
        Covariance of the slow waves.
    fast : shape (n_waves - n_slow, n_channels)
        Variances of the faster waves, independent of all else.
    trust : shape (n_channels,)
        Share of the take's own covariance in the estimate, 0 to 1: what is told by examples
        needs less of it than what is not.
    trust_in_gaps : shape (n_channels,)
        The same where channels have long gaps, which other channels of this body fill best.
    follows : shape (n_channels,)
        Share of the take's own mean in the mean, as the estimate gets better.
    """

    mean: Array
    slow: Array
    fast: Array
    own_weight: Array
    own_weight_in_gaps: Array
    mean_adaptation: Array
    smooth: SmoothPrior
    """The part of the covariance that can be fitted to the take."""
    decoupling: float = 0.5
    """Share by which channels are taken as independent where one of them has a long gap."""

    @property
    def n_slow(self) -> int:
        """Number of slow waves."""
        return len(self.slow)

    def truncated(self, n_coefficients: int) -> "WindowPrior":
        """Return the prior of windows that have only so many waves."""
        return replace(
            self,
            slow=self.slow[:n_coefficients, :, :n_coefficients],
            fast=self.fast[: max(n_coefficients - self.n_slow, 0)],
            smooth=replace(
                self.smooth, kernels=self.smooth.kernels[:, :n_coefficients, :n_coefficients]
            ),
        )

    def select_channels(self, channels: NDArray[np.intp]) -> "WindowPrior":
        """Return the prior of some of the channels."""
        return replace(
            self,
            mean=self.mean[channels],
            slow=self.slow[:, channels][:, :, :, channels],
            fast=self.fast[:, channels],
            own_weight=self.own_weight[channels],
            own_weight_in_gaps=self.own_weight_in_gaps[channels],
            mean_adaptation=self.mean_adaptation[channels],
            smooth=replace(self.smooth, weights=self.smooth.weights[:, channels]),
        )

    def with_smoothness(self, weights: Array) -> "WindowPrior":
        """Return the prior with other variances at each correlation time."""
        change = replace(self.smooth, weights=weights - self.smooth.weights)
        slow, channels, fraction = self.slow.copy(), np.arange(len(self.mean)), change.fraction
        slow[:, channels, :, channels] += fraction * change.slow(self.n_slow)
        fast = self.fast + fraction * change.fast(self.n_slow)
        return replace(self, slow=slow, fast=fast, smooth=replace(self.smooth, weights=weights))

    @property
    def deviation(self) -> Array:
        """Standard deviation of a frame from the mean, shape (n_channels,)."""
        variance = np.einsum("kckc->c", self.slow) + self.fast.sum(axis=0)
        return np.asarray(np.sqrt(variance / (self.n_slow + len(self.fast))))

    @property
    def matrix(self) -> Array:
        """The covariance of the slow waves as a square matrix, waves outermost."""
        size = self.n_slow * len(self.mean)
        return self.slow.reshape(size, size)


def count_slow_coefficients(window: int) -> int:
    """Return how many waves of a window are told together."""
    return max(round(SLOW_FRACTION * window), 1)


def build_smooth_prior(
    mean: Array, smooth: SmoothPrior, own_weight: float, own_weight_in_gaps: float
) -> WindowPrior:
    """Return the prior of channels of which only variance and smoothness are known."""
    n_slow, channels = count_slow_coefficients(smooth.kernels.shape[1]), np.arange(len(mean))
    slow = np.zeros((n_slow, len(mean), n_slow, len(mean)))
    slow[:, channels, :, channels] = smooth.slow(n_slow)
    zeros = np.zeros(len(mean))
    return WindowPrior(
        mean,
        slow,
        smooth.fast(n_slow),
        zeros + own_weight,
        zeros + own_weight_in_gaps,
        zeros,
        smooth,
    )


def mix_priors(examples: WindowPrior, own: WindowPrior, fraction: float) -> WindowPrior:
    """Return the examples' prior with a share of the one that knows only smoothness."""
    return replace(
        examples,
        slow=(1.0 - fraction) * examples.slow + fraction * own.slow,
        fast=(1.0 - fraction) * examples.fast + fraction * own.fast,
        smooth=replace(own.smooth, fraction=fraction),
    )
