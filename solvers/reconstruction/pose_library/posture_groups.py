"""Clusters of similar poses that speed up the search in large libraries."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Single, row_blocks
from ...motion.humanoid import ADULT_BONE_LENGTHS_M, positions_from_directions

MIN_POSTURES = 5000
"""Minimum number of poses for clustering; smaller libraries are searched completely. It bounds
the run time of searches."""
POSTURES_PER_GROUP = 250
"""Mean number of poses in a group. It bounds the run time: a query skips groups that are far
away."""
N_ROUNDS = 6
"""Number of iterations of k-means. It bounds the run time of indexing: groups that have not
converged only make searches slower."""


def group_postures(directions: Single) -> NDArray[np.int32]:
    """Return the group of each pose, shape (n_postures,); a single group for few poses.

    Lloyd's algorithm (k-means) on the joints of an adult of mean size. It starts from evenly
    spaced poses, so the result is deterministic.

    Parameters
    ----------
    directions : shape (n_postures, 20, 3)
    """
    n_postures = len(directions)
    if n_postures < MIN_POSTURES:
        return np.zeros(n_postures, dtype=np.int32)
    lengths: Single = ADULT_BONE_LENGTHS_M.astype(np.float32)
    points: Single = (
        positions_from_directions(directions, lengths)
        .reshape(n_postures, -1)
        .astype(np.float32)
    )
    n_groups = n_postures // POSTURES_PER_GROUP
    centers = points[np.linspace(0, n_postures - 1, n_groups).astype(int)]
    groups = _nearest_centers(points, centers)
    for _ in range(N_ROUNDS):
        order = np.argsort(groups, kind="stable")
        kept, starts, sizes = np.unique(groups[order], return_index=True, return_counts=True)
        centers[kept] = np.add.reduceat(points[order], starts, axis=0) / sizes[:, None]
        groups = _nearest_centers(points, centers)
    return groups


def _nearest_centers(points: Single, centers: Single) -> NDArray[np.int32]:
    squares = np.einsum("ij,ij->i", centers, centers)
    indices = [
        np.argmin(squares - 2.0 * (points[block] @ centers.T), axis=1)
        for block in row_blocks(len(points), len(centers))
    ]
    return np.asarray(np.concatenate(indices), dtype=np.int32)
