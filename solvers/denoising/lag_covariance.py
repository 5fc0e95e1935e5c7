"""The covariance of all windows of a clip, without ever building the windows."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

Array = NDArray[np.float64]

FIRST_GUESS = 160
"""Number of eigenvectors asked for at first; doubled until they hold enough."""


def lag_products(values: Array, window: int) -> Array:
    """Return the sum over all windows of the outer product of a window with itself.

    The block of lags (j + 1, k + 1) is that of (j, k) without its first frame and with one
    more at the end, so only the first row of blocks costs a pass over the frames.

    Parameters
    ----------
    values : shape (n_frames, n_channels)
        At least `window` frames.
    window : int, frames

    Returns
    -------
    Array
        Shape (window * n_channels, window * n_channels), frames outermost: C_D S_N of
        [LC10], eq. 2.3 to 2.5 of [LOU12], with channels and lags interchanged.
    """
    n_frames, n_channels = values.shape
    n_windows = n_frames - window + 1
    blocks = np.empty((window, window, n_channels, n_channels))
    for lag in range(window):
        blocks[0, lag] = values[:n_windows].T @ values[lag : lag + n_windows]
    for row in range(window - 1):
        ahead = slice(row + n_windows, window - 1 + n_windows)
        first = values[row][None, :, None] * values[row : window - 1, None, :]
        last = values[row + n_windows][None, :, None] * values[ahead, None, :]
        blocks[row + 1, row + 1 :] = blocks[row, row:-1] - first + last
    for row in range(1, window):
        blocks[row, :row] = blocks[:row, row].transpose(0, 2, 1)
    size = window * n_channels
    return blocks.transpose(0, 2, 1, 3).reshape(size, size)


def strongest(covariance: Array, energy: float) -> tuple[Array, Array]:
    """Return the largest eigenvalues that hold this share of the trace, and their vectors.

    Implicitly restarted Lanczos iteration; small matrices are solved whole. Each vector's
    largest entry is positive, so that the same clips give the same signs everywhere.
    """
    size, wanted = len(covariance), FIRST_GUESS
    total = float(np.trace(covariance))
    while True:
        if 3 * wanted >= size:
            values, vectors = eigh(covariance)
        else:
            values, vectors = eigsh(covariance, wanted, which="LA", v0=np.ones(size))
        order = np.argsort(values)[::-1]
        values, vectors = np.maximum(values[order], 0.0), vectors[:, order]
        enough = int(np.searchsorted(np.cumsum(values), energy * total)) + 1
        if enough <= len(values) or len(values) == size:
            values, vectors = values[:enough], vectors[:, :enough]
            peaks = np.abs(vectors).argmax(axis=0)
            signs = np.sign(vectors[peaks, np.arange(vectors.shape[1])])
            return values, vectors * np.where(signs == 0.0, 1.0, signs)
        wanted *= 2
