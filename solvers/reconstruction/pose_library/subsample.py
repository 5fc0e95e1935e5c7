"""Subsample poses to an even density: keep the most distinct ones."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion.humanoid import ADULT_BONE_LENGTHS_M, N_JOINTS, positions_from_directions
from ...progress import Progress, unwatched

N_COMPONENTS = 24
"""Number of principal components for distances; they retain all but millimeters. It bounds the
run time."""


def subsample_postures(
    vectors: Array, n_kept: int, spacing: float, progress: Progress = unwatched
) -> NDArray[np.intp]:
    """Return the indices of poses to keep, each farthest from all poses chosen before it.

    Stops at `n_kept` poses, or when the next pose is within `spacing` of a kept one. The first
    pose is the one nearest to the mean. (Farthest-point sampling, Gonzalez 1985,
    doi:10.1016/0304-3975(85)90224-5.)

    Parameters
    ----------
    vectors : shape (n_postures, n * 20, 3)
        Directions of bones, and their changes times `PACE_S`.
    n_kept : int
    spacing : float, meters
        Root mean square distance between the joints of two poses of an adult, with velocities
        as further coordinates.
    progress : Progress
    """
    blocks = np.split(vectors, vectors.shape[1] // N_JOINTS, axis=1)
    points = np.concatenate(
        [positions_from_directions(part, ADULT_BONE_LENGTHS_M) for part in blocks], axis=1
    )
    flat = points.reshape(len(points), -1)
    flat = flat - flat.mean(axis=0)
    _, axes = np.linalg.eigh(flat.T @ flat)
    projected = np.ascontiguousarray(flat @ axes[:, -N_COMPONENTS:], dtype=np.float32)
    squares = np.einsum("ij,ij->i", projected, projected)
    min_square = N_JOINTS * spacing**2
    next_index = int(np.argmin(squares))
    kept: list[int] = []
    distances = np.full(len(projected), np.inf, dtype=np.float32)
    for count in range(min(n_kept, len(projected))):
        kept.append(next_index)
        squared_distances = (
            squares + squares[next_index] - 2.0 * (projected @ projected[next_index])
        )
        np.minimum(distances, squared_distances, out=distances)
        distances[next_index] = 0.0
        next_index = int(np.argmax(distances))
        if distances[next_index] <= min_square:
            break
        if count % 64 == 0:
            progress(count / n_kept, "Subsampling poses")
    return np.array(kept, dtype=np.intp)
