"""Groups of alike postures, by which large libraries are searched."""

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import USUAL_LENGTHS, along_bones

Single = NDArray[np.float32]

MIN_POSTURES = 5000
"""Postures below which each is looked at."""
PER_GROUP = 250
N_ROUNDS = 6
BLOCK = 4096


def group_postures(directions: Single) -> NDArray[np.int32]:
    """Return the group of each posture, shape (n_postures,); all one group where they are few.

    Lloyd's algorithm (k-means) on the joints of a usual adult. It begins with evenly spaced
    postures, and so gives the same groups each time.

    Parameters
    ----------
    directions : shape (n_postures, 20, 3)
    """
    n_postures = len(directions)
    if n_postures < MIN_POSTURES:
        return np.zeros(n_postures, dtype=np.int32)
    single: Single = USUAL_LENGTHS.astype(np.float32)
    points: Single = along_bones(directions, single).reshape(n_postures, -1).astype(np.float32)
    n_groups = n_postures // PER_GROUP
    centres = points[np.linspace(0, n_postures - 1, n_groups).astype(int)]
    groups = _nearest_centers(points, centres)
    for _ in range(N_ROUNDS):
        order = np.argsort(groups, kind="stable")
        kept, starts, sizes = np.unique(groups[order], return_index=True, return_counts=True)
        centres[kept] = np.add.reduceat(points[order], starts, axis=0) / sizes[:, None]
        groups = _nearest_centers(points, centres)
    return groups


def _nearest_centers(points: Single, centres: Single) -> NDArray[np.int32]:
    squares = np.einsum("ij,ij->i", centres, centres)
    found = [
        np.argmin(squares - 2.0 * (points[start : start + BLOCK] @ centres.T), axis=1)
        for start in range(0, len(points), BLOCK)
    ]
    return np.asarray(np.concatenate(found), dtype=np.int32)
