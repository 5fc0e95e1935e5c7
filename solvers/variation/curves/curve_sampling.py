"""Sample curves between frames with cubic B-splines, whose second derivative is continuous."""

import numpy as np
import scipy

from ...arrays import Array

N_PADDING = 12
"""Frames by which curves are extrapolated at either end, to hide boundary effects. It
guards the ends of straight lines, which would curve: the effect of an end falls to 0.27 per
frame."""


def sample_linearly(curves: Array, times: Array) -> Array:
    """Return curves, (n_frames, n), at given times by linear interpolation; corners stay."""
    base_frames = np.clip(np.floor(times).astype(int), 0, max(len(curves) - 2, 0))
    fractions = (times - base_frames)[:, None]
    after = np.minimum(base_frames + 1, len(curves) - 1)
    return np.asarray((1.0 - fractions) * curves[base_frames] + fractions * curves[after])


def sample_curves(curves: Array, times: Array) -> Array:
    """Return curves at given times, shape (n_times, ...).

    The interpolating cubic B-spline (Unser 1999, Splines: a perfect fit for signal and image
    processing). At whole frames it returns the curves themselves.

    Parameters
    ----------
    curves : shape (n_frames, ...)
    times : shape (n_times,), frames, from 0 to n_frames - 1
    """
    n = len(curves)
    flat = curves.reshape(n, -1)
    if n < 2:
        return np.asarray(np.repeat(curves, len(times), axis=0))
    steps = np.minimum(np.arange(1, N_PADDING + 1), n - 1)
    before = 2.0 * flat[0] - flat[steps[::-1]]
    after = 2.0 * flat[-1] - flat[n - 1 - steps]
    knots = scipy.ndimage.spline_filter1d(
        np.concatenate([before, flat, after]), order=3, axis=0
    )
    base_frames = np.clip(np.floor(times).astype(int), 0, n - 1)
    fractions = times - base_frames
    weights = np.stack([
        (1.0 - fractions) ** 3,
        3.0 * fractions**3 - 6.0 * fractions**2 + 4.0,
        3.0 * (1.0 - fractions) ** 3 - 6.0 * (1.0 - fractions) ** 2 + 4.0,
        fractions**3,
    ], axis=-1) / 6.0  # fmt: skip
    columns = base_frames[:, None] + np.arange(N_PADDING - 1, N_PADDING + 3)
    rows = np.arange(0, 4 * len(times) + 1, 4)
    interpolation = scipy.sparse.csr_matrix(
        (weights.ravel(), columns.ravel(), rows), (len(times), len(knots))
    )
    return np.asarray((interpolation @ knots).reshape(len(times), *curves.shape[1:]))
