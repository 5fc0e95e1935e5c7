"""Choose postures of an even density: those that differ most from each other."""

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import N_JOINTS, USUAL_LENGTHS, along_bones
from ...progress import Progress, unwatched

Array = NDArray[np.float64]

N_COMPONENTS = 24
"""Principal components in which postures are compared; they hold all but millimetres."""


def subsample_postures(
    vectors: Array, n_kept: int, spacing: float, progress: Progress = unwatched
) -> NDArray[np.intp]:
    """Return which postures to keep: each the farthest from all that were chosen before it.

    Ends when enough are chosen, or when the next one is nearer than `spacing` to one of them.
    The first is the one nearest to the mean. (Farthest-point clustering, Gonzalez 1985,
    doi:10.1016/0304-3975(85)90224-5.)

    Parameters
    ----------
    vectors : shape (n_postures, n * 20, 3)
        Directions of bones, and their changes in the time that counts as much.
    n_kept : int
    spacing : float, metres
        Root of the mean square way between the joints of two postures of an adult, and between
        how far they get.
    progress : Progress
    """
    parts = np.split(vectors, vectors.shape[1] // N_JOINTS, axis=1)
    points = np.concatenate([along_bones(part, USUAL_LENGTHS) for part in parts], axis=1)
    flat = points.reshape(len(points), -1)
    flat = flat - flat.mean(axis=0)
    _, axes = np.linalg.eigh(flat.T @ flat)
    low = np.ascontiguousarray(flat @ axes[:, -N_COMPONENTS:], dtype=np.float32)
    squares = np.einsum("ij,ij->i", low, low)
    least = N_JOINTS * spacing**2
    next_one = int(np.argmin(squares))
    kept: list[int] = []
    nearest = np.full(len(low), np.inf, dtype=np.float32)
    for place in range(min(n_kept, len(low))):
        kept.append(next_one)
        away = squares + squares[next_one] - 2.0 * (low @ low[next_one])
        np.minimum(nearest, away, out=nearest)
        nearest[next_one] = 0.0
        next_one = int(np.argmax(nearest))
        if nearest[next_one] <= least:
            break
        if place % 64 == 0:
            progress(place / n_kept, "Thinning out postures")
    return np.array(kept, dtype=np.intp)
