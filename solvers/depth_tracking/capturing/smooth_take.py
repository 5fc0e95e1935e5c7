"""Smooth a complete take: unobserved coordinates follow from the frames before and after."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..body import N_COORDINATES

Array = NDArray[np.float64]

_FIRST_BAND, _SECOND_BAND = N_COORDINATES, 2 * N_COORDINATES
_MIN_WEIGHT = 1e-6


def smooth_take(
    poses: Array, equations: Sequence[tuple[Array, Array]], stiffness: Array
) -> Array:
    """Return the most probable poses of a take, given every frame at once.

    Around `poses` the negative log-likelihood is quadratic; accelerations cost `stiffness`.
    The minimum of the sum solves one banded linear system over all frames and coordinates.
    Well-observed limbs hardly move. Occluded limbs are interpolated between their
    observations before and after.

    Parameters
    ----------
    poses : shape (n_frames, 36)
        Linearization point of each frame.
    equations : sequence of (36, 36) and (36,) arrays, one pair per frame
        Likelihood there: matrix and vector of its normal equations; zeros for an empty frame.
    stiffness : shape (36,)
        Weight of squared second differences.
    """
    n_frames = len(poses)
    bands = np.zeros((_SECOND_BAND + 1, n_frames * N_COORDINATES))
    right_side = np.empty((n_frames, N_COORDINATES))
    for frame, (matrix, vector) in enumerate(equations):
        right_side[frame] = matrix @ poses[frame] + vector
        first = frame * N_COORDINATES
        for below in range(N_COORDINATES):
            columns = np.arange(N_COORDINATES - below)
            bands[below, first + columns] = matrix[columns + below, columns]
    bands[0] += _MIN_WEIGHT
    right_side += _MIN_WEIGHT * poses
    diagonal, first_band, second_band = _second_differences(n_frames)
    bands[0] += np.outer(diagonal, stiffness).ravel()
    bands[_FIRST_BAND] += np.outer(first_band, stiffness).ravel()
    bands[_SECOND_BAND] += np.outer(second_band, stiffness).ravel()
    solution: Array = solveh_banded(bands, right_side.ravel(), lower=True)
    return solution.reshape(n_frames, N_COORDINATES)


def _second_differences(n_frames: int) -> tuple[Array, Array, Array]:
    """Return the bands of D'D, D taking second differences: diagonal, first and second."""
    diagonal, first, second = np.zeros(n_frames), np.zeros(n_frames), np.zeros(n_frames)
    if n_frames >= 3:
        diagonal[:-2] += 1.0
        diagonal[1:-1] += 4.0
        diagonal[2:] += 1.0
        first[:-2] -= 2.0
        first[1:-1] -= 2.0
        second[:-2] += 1.0
    return diagonal, first, second
