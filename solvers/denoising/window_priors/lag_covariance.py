"""Compute the covariance of all windows of clips without building the windows."""

import numpy as np
import scipy

from ...arrays import Array

MAX_CLIP_ENDS = 64
"""Number of clips whose first and last frames are stored before they are summed."""
N_FIRST_EIGENVECTORS = 160
"""Number of eigenvectors requested first; doubled until they contain enough energy. It bounds
the run time."""


class LagProducts:
    """Sum the outer products of all windows of clips.

    The block of lags (j + 1, k + 1) equals that of (j, k) without the first frame and with one
    more at the end, for every clip. Only the first row of blocks needs a pass over the frames,
    and only the ends of clips have to be stored.
    """

    def __init__(self, n_channels: int, window: int) -> None:
        size = window * n_channels
        self._window, self._sum = window, np.zeros((size, size))
        self._first = np.zeros((n_channels, window, n_channels))
        self._heads, self._tails = list[Array](), list[Array]()

    def add(self, clip: Array) -> None:
        """Add the windows of a clip, shape (n_frames, n_channels), of at least one window."""
        last = len(clip) - self._window + 1
        for lag in range(self._window):
            self._first[:, lag] += clip[:last].T @ clip[lag : last + lag]
        self._heads.append(clip[: self._window - 1].copy())
        self._tails.append(clip[last:].copy())
        if len(self._heads) == MAX_CLIP_ENDS:
            self._flush()

    def total(self) -> Array:
        """Return the sum.

        Shape (window * n_channels, window * n_channels), frames outermost: C_D S_N of [LC10],
        eq. 2.3 to 2.5 of [LOU12], with channels and lags interchanged.
        """
        if self._heads:
            self._flush()
        return self._sum

    def _flush(self) -> None:
        """Add the stored ends of clips to the sum, and discard them."""
        n_channels, window, _ = self._first.shape
        blocks = np.empty((window, n_channels, window, n_channels))
        blocks[0] = self._first
        heads, tails = np.stack(self._heads), np.stack(self._tails)
        for row in range(window - 1):
            change = np.tensordot(tails[:, row], tails[:, row:], axes=(0, 0))
            change -= np.tensordot(heads[:, row], heads[:, row:], axes=(0, 0))
            blocks[row + 1, :, row + 1 :] = blocks[row, :, row:-1] + change
        for row in range(1, window):
            blocks[row, :, :row] = blocks[:row, :, row].transpose(2, 0, 1)
        self._sum += blocks.reshape(self._sum.shape)
        self._first[:] = 0.0
        self._heads, self._tails = [], []


class LagCovariance:
    """The lag covariance of clips, each about its given mean.

    A channel that a clip lacks (NaN) is estimated from the other clips. So that the result
    stays a covariance, the covariance of two channels weakens if they are seldom observed
    together.
    """

    def __init__(self, n_channels: int, window: int) -> None:
        self._products, self._window = LagProducts(n_channels, window), window
        self._n_windows = np.zeros(n_channels)

    def add(self, clip: Array, mean: Array, weight: float = 1.0) -> None:
        """Add a clip, shape (n_frames, n_channels), with this weight."""
        self._products.add(np.sqrt(weight) * np.nan_to_num(clip - mean))
        self._n_windows += weight * (len(clip) - self._window + 1) * np.isfinite(clip[0])

    def total(self) -> Array:
        """Return the covariance, with the shape of `LagProducts.total`."""
        scale = np.tile(np.sqrt(self._n_windows), self._window)
        total = self._products.total() / scale
        return np.asarray(total / scale[:, None])


def find_leading_eigenpairs(covariance: Array, energy: float) -> tuple[Array, Array]:
    """Return the largest eigenvalues that sum to this fraction of the trace, and their vectors.

    Each vector's largest entry is positive, so that the same clips give the same signs
    everywhere. Lanczos iteration (ARPACK) is twice as fast, but where the rank is low it goes
    on from random numbers that differ from call to call. Shapes are (n,) and (size, n), of a
    covariance (size, size).
    """
    size, n_wanted = len(covariance), N_FIRST_EIGENVECTORS
    total = float(np.trace(covariance))
    while True:
        n_wanted = min(n_wanted, size)
        values, vectors = scipy.linalg.eigh(
            covariance, subset_by_index=(size - n_wanted, size - 1)
        )
        values, vectors = np.maximum(values[::-1], 0.0), vectors[:, ::-1]
        n_enough = int(np.searchsorted(np.cumsum(values), energy * total)) + 1
        if n_enough <= len(values) or len(values) == size:
            values, vectors = values[:n_enough], vectors[:, :n_enough]
            peaks = np.abs(vectors).argmax(axis=0)
            signs = np.sign(vectors[peaks, np.arange(vectors.shape[1])])
            return values, vectors * np.where(signs == 0.0, 1.0, signs)
        n_wanted *= 2
