"""The penalty of acceleration, for banded linear systems over time."""

import numpy as np
from numpy.typing import NDArray


def second_difference_bands(n_frames: int) -> NDArray[np.float64]:
    """Return D'D, where D takes second differences over time, as LAPACK's upper bands.

    Shape (3, n_frames): the second and the first superdiagonal, then the diagonal; zeros for
    fewer than three frames.
    """
    bands = np.zeros((3, n_frames))
    if n_frames > 2:
        bands[0, 2:] = 1.0
        bands[1, 1:-1] -= 2.0
        bands[1, 2:] -= 2.0
        for first, square in enumerate((1.0, 4.0, 1.0)):
            bands[2, first : n_frames - 2 + first] += square
    return bands


def lower_block_bands(
    blocks: NDArray[np.float64],
    second_weights: NDArray[np.float64],
    between: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Return a matrix over frames and variables, with costs of acceleration, as LAPACK's bands.

    Parameters
    ----------
    blocks : shape (n_frames, n, n)
        Symmetric blocks of the frames; only their upper triangles are read.
    second_weights : shape (n,)
        Weights of the variables' squared second differences.
    between : shape (n_frames - 1, n, n), optional
        Blocks of a frame's rows and the next one's columns.

    Returns
    -------
    NDArray, shape (2 n + 1, n_frames n)
        The diagonal and the subdiagonals, for `scipy.linalg.solveh_banded(..., lower=True)`.
    """
    n_frames, n, _ = blocks.shape
    bands = np.zeros((n_frames, n, 2 * n + 1))
    for column in range(n):
        bands[:, column, : n - column] = blocks[:, column, column:]
        if between is not None:
            bands[:-1, column, n - column : 2 * n - column] = between[:, column]
    upper = second_difference_bands(n_frames)
    for ahead in range(3):
        differences = upper[2 - ahead, ahead:, None]
        bands[: n_frames - ahead, :, ahead * n] += differences * second_weights
    return bands.reshape(n_frames * n, -1).T
