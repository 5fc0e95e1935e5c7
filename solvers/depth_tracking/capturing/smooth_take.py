"""Smooth a whole take: what pictures leave open follows from the frames before and after."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..body import N_COORDINATES

Array = NDArray[np.float64]

_NEAR, _FAR = N_COORDINATES, 2 * N_COORDINATES
_LEAST = 1e-6


def smooth_take(
    poses: Array, equations: Sequence[tuple[Array, Array]], stiffness: Array
) -> Array:
    """Return the most probable poses of a take, given every frame at once.

    Around `poses` what the pictures ask for is quadratic; accelerations cost `stiffness`. The
    minimum of both is one banded linear system over all frames and coordinates. Well-observed
    limbs hardly move; limbs out of sight swing from where they were last seen to where they
    are seen next.

    Parameters
    ----------
    poses : shape (n_frames, 36)
        Where the frames were linearised.
    equations : sequence of (36, 36) and (36,) arrays, one pair per frame
        Likelihood there: matrix and vector of its normal equations; zeros for an empty frame.
    stiffness : shape (36,)
        Weight of squared second differences.
    """
    n_frames = len(poses)
    bands = np.zeros((_FAR + 1, n_frames * N_COORDINATES))
    wanted = np.empty((n_frames, N_COORDINATES))
    for frame, (matrix, vector) in enumerate(equations):
        wanted[frame] = matrix @ poses[frame] + vector
        first = frame * N_COORDINATES
        for below in range(N_COORDINATES):
            columns = np.arange(N_COORDINATES - below)
            bands[below, first + columns] = matrix[columns + below, columns]
    bands[0] += _LEAST
    wanted += _LEAST * poses
    diagonal, near, far = _second_differences(n_frames)
    bands[0] += np.outer(diagonal, stiffness).ravel()
    bands[_NEAR] += np.outer(near, stiffness).ravel()
    bands[_FAR] += np.outer(far, stiffness).ravel()
    smooth: Array = solveh_banded(bands, wanted.ravel(), lower=True)
    return smooth.reshape(n_frames, N_COORDINATES)


def _second_differences(n_frames: int) -> tuple[Array, Array, Array]:
    """Return the bands of D'D, D taking second differences: diagonal, first and second."""
    diagonal, near, far = np.zeros(n_frames), np.zeros(n_frames), np.zeros(n_frames)
    if n_frames >= 3:
        diagonal[:-2] += 1.0
        diagonal[1:-1] += 4.0
        diagonal[2:] += 1.0
        near[:-2] -= 2.0
        near[1:-1] -= 2.0
        far[:-2] += 1.0
    return diagonal, near, far
