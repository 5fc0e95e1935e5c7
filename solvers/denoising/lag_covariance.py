"""The covariance of all windows of clips, without ever building the windows."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh

Array = NDArray[np.float64]

FIRST_GUESS = 160
"""Number of eigenvectors asked for at first; doubled until they hold enough."""


def lag_products(clips: Sequence[Array], window: int) -> Array:
    """Return the sum over the windows of all clips of their outer products with themselves.

    The block of lags (j + 1, k + 1) is that of (j, k) without the first frame and with one
    more at the end, of every clip: only the first row of blocks costs a pass over the frames.

    Parameters
    ----------
    clips : sequence of arrays, shape (n_frames, n_channels)
        Each of at least `window` frames.
    window : int, frames

    Returns
    -------
    Array
        Shape (window * n_channels, window * n_channels), frames outermost: C_D S_N of
        [LC10], eq. 2.3 to 2.5 of [LOU12], with channels and lags interchanged.
    """
    n_channels = clips[0].shape[1]
    blocks = np.empty((window, n_channels, window, n_channels))
    for lag in range(window):
        blocks[0, :, lag] = sum(
            clip[: len(clip) - window + 1].T @ clip[lag : len(clip) - window + 1 + lag]
            for clip in clips
        )
    heads = np.stack([clip[: window - 1] for clip in clips])
    tails = np.stack([clip[len(clip) - window + 1 :] for clip in clips])
    for row in range(window - 1):
        change = np.tensordot(tails[:, row], tails[:, row:], axes=(0, 0))
        change -= np.tensordot(heads[:, row], heads[:, row:], axes=(0, 0))
        blocks[row + 1, :, row + 1 :] = blocks[row, :, row:-1] + change
    for row in range(1, window):
        blocks[row, :, :row] = blocks[:row, :, row].transpose(2, 0, 1)
    size = window * n_channels
    return blocks.reshape(size, size)


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
