"""What is expected of a window before the take is seen: a Gaussian over its waves."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.fft import idct

Array = NDArray[np.float64]

SMOOTH_LENGTHS = (0.1, 0.3, 1.0)
"""Correlation times, seconds, of movement of which nothing else is known."""
SLOW_SHARE = 0.6
"""Share of the waves, slowest first, that are told together; faster ones are independent."""
FASTEST = 1e-4
"""Variance, relative to a channel's own, that any fast wave may have."""


@dataclass(frozen=True, eq=False)
class WavePrior:
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
    trust_alone : shape (n_channels,)
        The same of the take's own covariance of the channel with itself, in addition.
    follows : shape (n_channels,)
        Share of the take's own mean in the mean, as the estimate gets better.
    """

    mean: Array
    slow: Array
    fast: Array
    trust: Array
    trust_alone: Array
    follows: Array
    caution: float = 0.5
    """Share by which channels are taken as independent where one of them has a long gap."""

    @property
    def n_slow(self) -> int:
        """Number of slow waves."""
        return len(self.slow)

    def at_most(self, n_waves: int) -> "WavePrior":
        """Return the prior of windows that have only so many waves."""
        return replace(
            self,
            slow=self.slow[:n_waves, :, :n_waves],
            fast=self.fast[: max(n_waves - self.n_slow, 0)],
        )

    def of_channels(self, channels: NDArray[np.intp]) -> "WavePrior":
        """Return the prior of some of the channels."""
        return replace(
            self,
            mean=self.mean[channels],
            slow=self.slow[:, channels][:, :, :, channels],
            fast=self.fast[:, channels],
            trust=self.trust[channels],
            trust_alone=self.trust_alone[channels],
            follows=self.follows[channels],
        )

    @property
    def matrix(self) -> Array:
        """The covariance of the slow waves as a square matrix, waves outermost."""
        size = self.n_slow * len(self.mean)
        return self.slow.reshape(size, size)


def n_slow_waves(window: int) -> int:
    """Return how many waves of a window are told together."""
    return max(round(SLOW_SHARE * window), 1)


def smooth_prior(
    mean: Array,
    variance: Array,
    window: int,
    frame_rate: float,
    trust: float,
    trust_alone: float,
) -> WavePrior:
    """Return the prior of channels of which only variance and smoothness are known."""
    steps = np.subtract.outer(np.arange(window), np.arange(window)) / frame_rate
    kernels = [np.exp(-0.5 * (steps / length) ** 2) for length in SMOOTH_LENGTHS]
    waves = idct(np.eye(window), axis=0, norm="ortho")
    kernel = waves.T @ (sum(kernels) / len(kernels)) @ waves
    n_slow, n_channels = n_slow_waves(window), len(mean)
    slow = np.einsum("kj,cd->kcjd", kernel[:n_slow, :n_slow], np.diag(variance))
    fast = np.outer(np.diag(kernel)[n_slow:] + FASTEST, variance)
    return WavePrior(
        mean,
        slow,
        fast,
        np.full(n_channels, trust),
        np.full(n_channels, trust_alone),
        np.zeros(n_channels),
    )


def mixed(examples: WavePrior, smooth: WavePrior, share: float) -> WavePrior:
    """Return the examples' prior with a share of the one that knows only smoothness."""
    return replace(
        examples,
        slow=(1.0 - share) * examples.slow + share * smooth.slow,
        fast=(1.0 - share) * examples.fast + share * smooth.fast,
    )
