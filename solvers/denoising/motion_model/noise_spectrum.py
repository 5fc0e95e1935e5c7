"""The spectrum of noise that is correlated over time."""

import numpy as np

from ...arrays import Array
from ...signals import DIFFERENCE_ORDER


def noise_spectrum(
    n_coefficients: int, length: int, frame_rate: float, correlation_s: float
) -> Array:
    """Return the variance of the DCT coefficients of noise, relative to that of white noise.

    The noise is a first-order autoregressive process, an Ornstein-Uhlenbeck process at the
    frames [1]_. White noise is one with as large differences of the third order, by which noise
    is measured.

    Parameters
    ----------
    n_coefficients : int
        The first ones of a window.
    length : int
        Frames of a window.
    frame_rate : float, Hz
    correlation_s : float, seconds
        Time in which the correlation falls to 1 / e; 0 for white noise.

    Returns
    -------
    shape (n_coefficients,)

    References
    ----------
    .. [1] Brockwell, Davis (1991). Time Series: Theory and Methods, example 4.4.2.
    """
    correlation = frame_correlation(frame_rate, correlation_s)
    frequencies = np.pi * np.arange(n_coefficients) / length
    power = (1.0 - correlation**2) / (
        1.0 - 2.0 * correlation * np.cos(frequencies) + correlation**2
    )
    return np.asarray(power * deviation_ratio(frame_rate, correlation_s) ** 2)


def deviation_ratio(frame_rate: float, correlation_s: float) -> float:
    """Return the deviation of noise, relative to white noise with the same third differences.

    Parameters
    ----------
    frame_rate : float, Hz
    correlation_s : float, seconds
        As for `noise_spectrum`.
    """
    taps = np.poly1d([1.0, -1.0]) ** DIFFERENCE_ORDER
    lags = np.abs(np.subtract.outer(range(DIFFERENCE_ORDER + 1), range(DIFFERENCE_ORDER + 1)))
    correlations = frame_correlation(frame_rate, correlation_s) ** lags
    differences = taps.coeffs @ correlations @ taps.coeffs
    return float(np.sqrt(np.square(taps.coeffs).sum() / differences))


def frame_correlation(frame_rate: float, correlation_s: float) -> float:
    """Return the correlation of the noise of two successive frames, 0 to 1."""
    return float(np.exp(-1.0 / (frame_rate * correlation_s))) if correlation_s > 0.0 else 0.0
