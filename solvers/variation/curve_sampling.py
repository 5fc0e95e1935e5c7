"""Curves between their frames: cubic B-splines, whose second derivative does not jump."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import spline_filter1d
from scipy.sparse import csr_matrix

Array = NDArray[np.float64]

BESIDE = 12
"""Frames by which curves are continued at either end, so that the ends do not show."""


def between_frames(curves: Array, times: Array) -> Array:
    """Return curves, (n_frames, n), at moments by straight lines: for those with corners."""
    whole = np.clip(np.floor(times).astype(int), 0, max(len(curves) - 2, 0))
    part = (times - whole)[:, None]
    after = np.minimum(whole + 1, len(curves) - 1)
    return np.asarray((1.0 - part) * curves[whole] + part * curves[after])


def sample_curves(curves: Array, times: Array) -> Array:
    """Return curves at moments, shape (n_times, ...).

    The interpolating cubic B-spline (Unser 1999, Splines: a perfect fit for signal and image
    processing); at whole frames it gives the curves themselves.

    Parameters
    ----------
    curves : shape (n_frames, ...)
    times : shape (n_times,), frames, from 0 to n_frames - 1
    """
    n = len(curves)
    flat = curves.reshape(n, -1)
    if n < 2:
        return np.asarray(np.repeat(curves, len(times), axis=0))
    steps = np.minimum(np.arange(1, BESIDE + 1), n - 1)
    before = 2.0 * flat[0] - flat[steps[::-1]]
    after = 2.0 * flat[-1] - flat[n - 1 - steps]
    knots = spline_filter1d(np.concatenate([before, flat, after]), order=3, axis=0)
    whole = np.clip(np.floor(times).astype(int), 0, n - 1)
    part = times - whole
    weights = np.stack([
        (1.0 - part) ** 3,
        3.0 * part**3 - 6.0 * part**2 + 4.0,
        3.0 * (1.0 - part) ** 3 - 6.0 * (1.0 - part) ** 2 + 4.0,
        part**3,
    ], axis=-1) / 6.0  # fmt: skip
    columns = whole[:, None] + np.arange(BESIDE - 1, BESIDE + 3)
    rows = np.arange(0, 4 * len(times) + 1, 4)
    taken = csr_matrix((weights.ravel(), columns.ravel(), rows), (len(times), len(knots)))
    return np.asarray((taken @ knots).reshape(len(times), *curves.shape[1:]))
