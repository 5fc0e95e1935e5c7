"""The spectrum of noise whose power depends on the frequency."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...signals import DIFFERENCE_ORDER

FILTER_FLOOR = 1e-9
"""Power that a filter leaves of the highest frequencies, a fraction. It guards the inverse of a
spectrum: x1000 changes the noise of takes at 240 Hz."""


NO_CUTOFF = 0.5
"""Cutoff without which nothing is filtered, cycles per frame. By definition the highest
frequency."""


@dataclass(frozen=True)
class NoiseSpectrum:
    """The power of noise over the frequency, relative to white noise.

    It is that of a power law [1]_ after a digital low-pass filter of Butterworth [2]_ of second
    order. At frequency 0 it is that of half the lowest frequency of a window.

    References
    ----------
    .. [1] Kasdin (1995). Discrete simulation of colored noise and stochastic processes and
       1/f^alpha power law noise generation. Proceedings of the IEEE 83. doi:10.1109/5.381848
    .. [2] Winter (2009). Biomechanics and motor control of human movement, section 3.4.4.
    """

    exponent: float = 0.0
    """The power falls with frequency ** -exponent: white noise has 0, 1/f noise 1, and a random
    walk 2."""
    cutoff: float = NO_CUTOFF
    """Frequency at which each run of the filter leaves half of the power, cycles per frame."""
    n_runs: int = 1
    """Number of times that the filter ran: twice, forward and backward, without lag."""
    scale: float = 1.0
    """Standard deviation of the noise, relative to that which its third differences show."""

    @property
    def is_white(self) -> bool:
        """Whether all frequencies have the same power."""
        return not self.exponent and self.cutoff == NO_CUTOFF

    def variances(self, length: int) -> Array:
        """Return the variances of the DCT coefficients of a window of so many frames.

        Shape (length,), relative to the variance of a sample: their mean is 1.
        """
        frequencies = np.maximum(np.arange(length), 0.5) / (2 * length)
        warped = np.tan(np.pi * frequencies) / np.tan(np.pi * self.cutoff)
        passed = (1.0 + warped**4) ** -self.n_runs
        power = frequencies**-self.exponent * (passed + FILTER_FLOOR)
        return np.asarray(power / power.mean())

    def deviation_ratio(self, length: int) -> float:
        """Return the deviation of the noise, relative to white noise with equal differences.

        By third differences the noise of a take is measured. `length` is that of a window.
        """
        half_angles = np.pi * np.arange(length) / (2 * length)
        response = np.sin(half_angles) ** (2 * DIFFERENCE_ORDER)
        ratio = (response @ np.ones(length)) / (response @ self.variances(length))
        return float(self.scale * np.sqrt(ratio))


WHITE = NoiseSpectrum()
