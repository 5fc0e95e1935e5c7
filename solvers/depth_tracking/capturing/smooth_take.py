"""Smooth a complete take: unobserved coordinates follow from the frames before and after."""

from collections.abc import Sequence

import numpy as np
from scipy.linalg import solveh_banded

from ...arrays import Array
from ...signals import second_difference_bands
from ..body import N_COORDINATES

_FIRST_BAND, _SECOND_BAND = N_COORDINATES, 2 * N_COORDINATES
_MIN_WEIGHT = 1e-6
"""Weight per square radian of a pose without observations. It guards a factorization."""


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
    upper = second_difference_bands(n_frames)
    for band, lag in ((0, 0), (_FIRST_BAND, 1), (_SECOND_BAND, 2)):
        bands[band] += np.outer(np.roll(upper[2 - lag], -lag), stiffness).ravel()
    solution: Array = solveh_banded(bands, right_side.ravel(), lower=True)
    return solution.reshape(n_frames, N_COORDINATES)
