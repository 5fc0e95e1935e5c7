"""Smooth a complete take: unobserved coordinates follow from the frames before and after."""

from collections.abc import Sequence

import numpy as np
import scipy

from ...arrays import Array
from ...signals import lower_block_bands
from ..body import N_COORDINATES

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
    blocks = np.empty((n_frames, N_COORDINATES, N_COORDINATES))
    right_side = np.empty((n_frames, N_COORDINATES))
    for frame, (matrix, vector) in enumerate(equations):
        blocks[frame] = matrix.T
        right_side[frame] = matrix @ poses[frame] + vector
    diagonal = np.arange(N_COORDINATES)
    blocks[:, diagonal, diagonal] += _MIN_WEIGHT
    right_side += _MIN_WEIGHT * poses
    bands = lower_block_bands(blocks, stiffness)
    solution: Array = scipy.linalg.solveh_banded(bands, right_side.ravel(), lower=True)
    return solution.reshape(n_frames, N_COORDINATES)
