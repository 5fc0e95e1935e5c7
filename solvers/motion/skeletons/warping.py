"""Align two motions in time by dynamic time warping."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError


@dataclass(frozen=True, eq=False)
class Alignment:
    """Correspondence between the frames of two motions."""

    cost: float
    """Mean distance per step of the path, in the units of the data."""
    path: NDArray[np.intp]
    """Pairs (frame of the first, frame of the second), shape (n_steps, 2), from the first
    frames of both to the last of both, monotonic and without skipped frames."""
    distances: NDArray[np.float64]
    """Distance of each pair, shape (n_steps,)."""


def warp(
    a: NDArray[np.float64], b: NDArray[np.float64], window: float | None = None
) -> Alignment:
    """Find the alignment of two sequences with the least total distance.

    Dynamic programming over steps (1, 0), (0, 1) and (1, 1), all of weight one, as first
    described in [1]_; the total is then divided by the number of steps.

    Parameters
    ----------
    a, b : shape (n_frames, n_features) or (n_frames, n_joints, n_features)
        The distance of two frames is the Euclidean distance of their features, averaged over
        joints. Joints that are missing (NaN) in either frame are left out of the mean.
    window : float, optional
        Half width of the Sakoe-Chiba band [1]_ around the diagonal, as a fraction of the
        longer sequence, 0 to 1. A narrow band forbids strong warping. None allows every path.

    Returns
    -------
    Alignment
        Symmetric: `warp(b, a)` has the same cost. Needs about 45 bytes for each pair of frames:
        0.4 GB for two clips of 3,000 frames.

    Raises
    ------
    InvalidMotionError
        A sequence is empty, shapes differ, or no pair of frames has a joint in common.

    References
    ----------
    .. [1] Sakoe, Chiba (1978). Dynamic programming algorithm optimization for spoken word
       recognition. IEEE Trans. Acoustics, Speech, and Signal Processing 26(1).
       doi:10.1109/TASSP.1978.1163055
    """
    a, b = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if a.ndim not in {2, 3} or not a.size or not b.size or a.shape[1:] != b.shape[1:]:
        raise InvalidMotionError(
            "Two sequences to align need at least one frame each and the same joints and"
            f" features; their shapes are {a.shape} and {b.shape}."
        )
    distances = frame_distances(a, b)
    allowed = np.where(_band(len(a), len(b), window), distances, np.inf)
    path = _cheapest_path(_accumulate_costs(allowed))
    path_distances = distances[path[:, 0], path[:, 1]]
    return Alignment(float(path_distances.mean()), path, path_distances)


def frame_distances(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the distance of each frame of `a` to each of `b`, shape (n_frames_a, n_frames_b).

    As in `warp`; pairs without a common joint get the mean distance of all others.

    Raises
    ------
    InvalidMotionError
        No pair of frames has a joint in common.
    """
    # A tenth of a second of every process to import: only when needed.
    from scipy.spatial.distance import cdist

    a, b = (x[:, None] if x.ndim == 2 else x for x in (a, b))
    total = np.zeros((len(a), len(b)))
    common = np.zeros((len(a), len(b)))
    for joint in range(a.shape[1]):
        separation = cdist(a[:, joint], b[:, joint])
        valid = np.isfinite(separation)
        total += np.where(valid, separation, 0.0)
        common += valid
    if not common.any():
        raise InvalidMotionError("No two frames have an observed joint in common.")
    mean = total / np.maximum(common, 1.0)
    return np.where(common > 0.0, mean, mean[common > 0.0].mean())


def _band(n: int, m: int, window: float | None) -> NDArray[np.bool_]:
    """Return which pairs are inside the Sakoe-Chiba band; the diagonal always is."""
    if window is None:
        return np.ones((n, m), dtype=bool)
    slope = (m - 1) / max(n - 1, 1)
    offset = np.abs(np.arange(m) - slope * np.arange(n)[:, None])
    return np.asarray(offset <= max(window * max(n, m), slope, 1.0))


def _accumulate_costs(distances: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the least total cost up to each pair, shape (n + 1, m + 1), padded with infinity.

    All pairs (i, j) of one anti-diagonal i + j = k depend only on the two before it, so one
    numpy expression computes them all.
    """
    n, m = distances.shape
    total = np.full((n + 1, m + 1), np.inf)
    total[0, 0] = 0.0
    for k in range(n + m - 1):
        i = np.arange(max(0, k - m + 1), min(n, k + 1))
        j = k - i
        before = np.minimum(np.minimum(total[i, j + 1], total[i + 1, j]), total[i, j])
        total[i + 1, j + 1] = distances[i, j] + before
    return total


def _cheapest_path(total: NDArray[np.float64]) -> NDArray[np.intp]:
    """Backtrack from the last pair to the first along the cheapest neighbors."""
    i, j = total.shape[0] - 2, total.shape[1] - 2
    path = [(i, j)]
    while i or j:
        # Pair (i, j) is total[i + 1, j + 1]; equal costs prefer the diagonal.
        _, _, i, j = min(
            (total[i, j], 0, i - 1, j - 1),
            (total[i, j + 1], 1, i - 1, j),
            (total[i + 1, j], 2, i, j - 1),
        )
        path.append((i, j))
    return np.array(path[::-1], dtype=np.intp)
