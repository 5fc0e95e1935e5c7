"""The spectrum of noise whose power falls with the frequency."""

import numpy as np

from ...arrays import Array
from ...signals import DIFFERENCE_ORDER


def noise_spectrum(length: int, exponent: float) -> Array:
    """Return the variance of the DCT coefficients of noise, relative to that of a sample.

    The noise has a power of frequency ** -exponent [1]_: it is white with an exponent of 0,
    1/f noise with 1, and a random walk with 2. Below half of the lowest frequency of a window
    its power is constant.

    Parameters
    ----------
    length : int
        Frames of a window.
    exponent : float

    Returns
    -------
    shape (length,)
        Their mean is 1.

    References
    ----------
    .. [1] Kasdin (1995). Discrete simulation of colored noise and stochastic processes and
       1/f^alpha power law noise generation. Proceedings of the IEEE 83. doi:10.1109/5.381848
    """
    frequencies = np.maximum(np.arange(length), 0.5) / length
    power = frequencies**-exponent
    return np.asarray(power / power.mean())


def deviation_ratio(length: int, exponent: float) -> float:
    """Return the deviation of noise, relative to white noise with the same third differences.

    By these the noise of a take is measured. For the parameters see `noise_spectrum`.
    """
    spectrum = noise_spectrum(length, exponent)
    half_angles = np.pi * np.arange(length) / (2 * length)
    response = np.sin(half_angles) ** (2 * DIFFERENCE_ORDER)
    return float(np.sqrt((response @ np.ones(length)) / (response @ spectrum)))
