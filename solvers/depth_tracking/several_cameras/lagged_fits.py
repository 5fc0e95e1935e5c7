"""Fit a rigid transform between two tracks at every time lag at once."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array, Integers
from ...rotations import nearest_rotations

Correlation = Callable[[Array, Array], Array]
_NO_WEIGHT = 1e-9
"""Sum of weights below which frames do not overlap. It guards a division by rounding errors."""


@dataclass(frozen=True, eq=False)
class LaggedFits:
    """The fit of two tracks at each time lag.

    Attributes
    ----------
    lags : int, shape (n_lags,)
        Frame k of the second track is compared with frame k + lag of the first.
    weights : shape (n_lags,)
        Sum of the weights of all pairs of points.
    mismatch : shape (n_lags,), square meters
        Mean squared distance of the points after the best rigid transform.
    movement : shape (n_lags,), square meters
        Mean squared distance of the points of both tracks from their mean position: what the
        mismatch of two unrelated motions would be.
    """

    lags: Integers
    weights: Array
    mismatch: Array
    movement: Array


def fit_all_lags(first: tuple[Array, Array], second: tuple[Array, Array]) -> LaggedFits:
    """Fit rotation and translation at every lag, in closed form [1]_.

    The sums of a weighted Procrustes fit are products of one value of each track. Over all
    lags they are cross-correlations, so Fourier transforms give them all together.

    Parameters
    ----------
    first, second : pair of shape (n_frames, n_points, 3) and (n_frames, n_points)
        Positions in meters and their weights, with one frame rate; weight 0: missing.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors. Acta
       Crystallographica A32. doi:10.1107/S0567739476001873
    """
    n_first, n_second = len(first[1]), len(second[1])
    size = int(scipy.fft.next_fast_len(n_first + n_second - 1, real=True))

    def correlate(left: Array, right: Array) -> Array:
        """Return the spectrum of the cross-correlation of two series."""
        spectrum: Array = scipy.fft.rfft(left, size) * np.conj(scipy.fft.rfft(right, size))
        return spectrum

    lags = np.arange(-(n_second - 1), n_first)
    n_points = first[1].shape[1]
    totals = np.zeros((size // 2 + 1, 18), dtype=complex)
    movement = np.zeros(len(lags))
    for point in range(n_points):
        products = _products(first, second, point, correlate)
        totals += products
        sums = _in_time(products[:, :9], size)[lags]
        movement += _spread(sums[:, 0], sums[:, 1:4], sums[:, 7])
        movement += _spread(sums[:, 0], sums[:, 4:7], sums[:, 8])
    sums = _in_time(totals, size)[lags]
    weights = np.maximum(sums[:, 0], _NO_WEIGHT)
    means = sums[:, 1:4], sums[:, 4:7]
    crossed = sums[:, 9:].reshape(-1, 3, 3)
    crossed = crossed - means[0][:, :, None] * means[1][:, None] / weights[:, None, None]
    explained = nearest_rotations(crossed)[1].sum(axis=1)
    squares = _spread(weights, means[0], sums[:, 7]) + _spread(weights, means[1], sums[:, 8])
    mismatch = np.maximum(squares - 2.0 * explained, 0.0) / weights
    return LaggedFits(lags, sums[:, 0], mismatch, movement / weights)


def _products(
    first: tuple[Array, Array], second: tuple[Array, Array], point: int, correlate: Correlation
) -> Array:
    """Return the spectra of the 18 sums of one point, shape (n_frequencies, 18).

    They are the weight, the positions of both (3 and 3), their squares (2), and the products of
    both positions (9).
    """
    positions, weights = zip(first, second, strict=True)
    weight = [each[:, point] for each in weights]
    weighted = [w[:, None] * each[:, point] for w, each in zip(weight, positions, strict=True)]
    squares = [
        (moment * each[:, point]).sum(axis=1)
        for moment, each in zip(weighted, positions, strict=True)
    ]
    return np.stack(
        [
            correlate(weight[0], weight[1]),
            *(correlate(weighted[0][:, i], weight[1]) for i in range(3)),
            *(correlate(weight[0], weighted[1][:, i]) for i in range(3)),
            correlate(squares[0], weight[1]), correlate(weight[0], squares[1]),
            *(correlate(weighted[0][:, i], weighted[1][:, k])
              for i in range(3) for k in range(3)),
        ],
        axis=1,
    )  # fmt: skip


def _in_time(spectra: Array, size: int) -> Array:
    """Return real series (size, n); an index is a lag, also from the end."""
    series: Array = scipy.fft.irfft(spectra, size, axis=0)
    return series


def _spread(weights: Array, sums: Array, squares: Array) -> Array:
    """Return the weighted sum of squared distances from the mean."""
    spread: Array = squares - (sums**2).sum(axis=1) / np.maximum(weights, _NO_WEIGHT)
    return np.maximum(spread, 0.0)
