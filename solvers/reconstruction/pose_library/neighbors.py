"""Find the library poses nearest to an observed pose, with joints weighted by reliability."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers, Single, row_blocks
from ...motion.humanoid import N_JOINTS
from ...progress import Progress, unwatched
from ..joint_rotations import BodyPostures
from ..residual_correction import squared_distances

CANDIDATE_FACTOR = 1.3
"""Ratio of candidates from the float32 distances to neighbors from the exact ones. It guards
the order of neighbors against rounding; x0.5 would find too few."""


class PostureQuery(NamedTuple):
    """Observed poses to search for.

    Attributes
    ----------
    postures : shape (n_frames, 20, 3), meters
        NaN: missing.
    speeds : shape (n_frames, 20, 3), meters per second
    reliability : shape (n_frames, 20)
    pace : float, seconds
        Time that converts velocities to distances; 0: only the pose counts, as in
        [SHJT13].
    """

    postures: Array
    speeds: Array
    reliability: Array
    pace: float

    def slice(self, start: int, stop: int) -> "PostureQuery":
        """Return the frames from `start` up to, not including, `stop`."""
        part = slice(start, stop)
        return PostureQuery(
            self.postures[part], self.speeds[part], self.reliability[part], self.pace
        )


@dataclass(frozen=True, eq=False)
class PostureIndex:
    """Search index over the poses of one body, in groups of similar ones.

    Attributes
    ----------
    order : shape (n_postures,)
        Indices into the library, group by group.
    starts : shape (n_groups + 1,)
        Where each group begins in `order`.
    points : float32, shape (n_postures, 40, 3)
        Positions and speeds, in that order.
    squares : float32, shape (n_postures, 40)
    centers : float32, shape (n_groups, 40, 3)
    radii : float32, shape (n_groups, 40)
        Root mean square distance of a group's points from its center.
    """

    order: Integers
    starts: Integers
    points: Single
    squares: Single
    centers: Single
    radii: Single


def index_postures(body: BodyPostures, groups: NDArray[np.int32]) -> PostureIndex:
    """Build the search index over the poses of one body.

    Parameters
    ----------
    body : BodyPostures
    groups : shape (n_postures,)
        Index of the group of each; 0 for all: every pose is compared.
    """
    order = np.argsort(groups, kind="stable")
    _, starts = np.unique(groups[order], return_index=True)
    points = np.concatenate([body.positions, body.speeds], axis=1)[order]
    sizes = np.diff(np.append(starts, len(order)))
    centers = np.add.reduceat(points, starts, axis=0) / sizes[:, None, None]
    differences = points - np.repeat(centers, sizes, axis=0)
    spread = np.add.reduceat(np.einsum("nik,nik->ni", differences, differences), starts, axis=0)
    return PostureIndex(
        order, np.append(starts, len(order)), points,
        np.einsum("nik,nik->ni", points, points), centers.astype(np.float32),
        np.sqrt(spread / sizes[:, None]).astype(np.float32),
    )  # fmt: skip


def nearest_postures(
    index: PostureIndex,
    query: PostureQuery,
    n_neighbors: int = 30,
    *,
    n_looked_at: int = 8000,
    progress: Progress = unwatched,
) -> tuple[Integers, Array]:
    """Find the nearest poses by the weighted distance of [SHJT13], eq. 9.

    Groups are searched in the order of their expected distance until `n_looked_at` poses were
    compared, so that the time hardly grows with the library. The expected distance of a group
    is the weighted squared distance from the query to its center, less the group's radius,
    joint by joint. Any weights are possible, so they need no quantization as in the paper.
    To a frame without weights all poses are equally near: it gets poses from all groups.

    Parameters
    ----------
    index : PostureIndex
    query : Query
    n_neighbors : int
    n_looked_at : int
        Minimum number of poses compared with each frame; more find more of the true nearest.
    progress : Progress

    Returns
    -------
    indices : shape (n_frames, n_neighbors)
        Into the library, the nearest first; fewer where the library has fewer.
    distances : shape (n_frames, n_neighbors), square meters
    """
    n_neighbors = min(n_neighbors, len(index.order))
    n_frames = len(query.postures)
    indices = np.empty((n_frames, n_neighbors), dtype=np.intp)
    distances = np.empty((n_frames, n_neighbors))
    search_all = len(index.starts) == 2 or len(index.order) <= n_looked_at
    n_compared = len(index.order) if search_all else n_looked_at
    spread = np.arange(n_neighbors) * len(index.order) // n_neighbors
    for part in row_blocks(n_frames, n_compared):
        points, weights = _as_points(query.slice(part.start, part.stop))
        if search_all:
            indices[part], distances[part] = _search_all(index, points, weights, n_neighbors)
        else:
            found = _search_groups(index, points, weights, n_neighbors, n_looked_at)
            indices[part], distances[part] = found
        indices[part][~weights.any(axis=1)] = spread
        progress(part.stop / n_frames, "Searching similar poses")
    return index.order[indices], distances


def _as_points(query: PostureQuery) -> tuple[Single, Single]:
    """Return positions and velocities without NaN, and their weights."""
    points = np.concatenate([query.postures, query.speeds], axis=1)
    weights = np.concatenate([query.reliability, query.pace**2 * query.reliability], axis=1)
    is_observed = np.isfinite(points).all(axis=-1)
    points = np.where(is_observed[..., None], points, 0.0)
    return points.astype(np.float32), np.where(is_observed, weights, 0.0).astype(np.float32)


def _relative_distances(
    points: Single, weights: Single, known: Single, squares: Single
) -> Single:
    """Weighted squared distances up to a constant per query, (n_frames, n_known)."""
    if not weights[:, N_JOINTS:].any():  # velocities are unknown: half of the memory to read
        points, weights, known, squares = (
            each[:, :N_JOINTS] for each in (points, weights, known, squares)
        )
    weighted = (points * weights[..., None]).reshape(len(points), -1)
    return np.asarray(weights @ squares.T - 2.0 * (weighted @ known.reshape(len(known), -1).T))


def _search_all(
    index: PostureIndex, points: Single, weights: Single, n_neighbors: int
) -> tuple[Integers, Array]:
    relative = _relative_distances(points, weights, index.points, index.squares)
    n_taken = min(int(CANDIDATE_FACTOR * n_neighbors), len(index.order))
    candidates = np.argpartition(relative, n_taken - 1, axis=1)[:, :n_taken]
    return _sort_candidates(index, points, weights, candidates, n_neighbors)


def _sort_candidates(
    index: PostureIndex,
    points: Single,
    weights: Single,
    candidates: Integers,
    n_neighbors: int,
) -> tuple[Integers, Array]:
    """Sort candidates by their exact distance."""
    differences = index.points[candidates] - points[:, None]
    squares = np.einsum("fnik,fnik,fi->fn", differences, differences, weights, optimize=False)
    best = np.argsort(squares, axis=1, kind="stable")[:, :n_neighbors]
    return np.take_along_axis(candidates, best, axis=1), np.take_along_axis(
        squares, best, axis=1
    )


def _search_groups(
    index: PostureIndex, points: Single, weights: Single, n_neighbors: int, n_looked_at: int
) -> tuple[Integers, Array]:
    sizes = np.diff(index.starts)
    ranked = np.argsort(_expected_distances(index, points, weights), axis=1, kind="stable")
    n_compared = np.cumsum(sizes[ranked], axis=1)
    n_groups = (n_compared < n_looked_at).sum(axis=1) + 1
    chosen = np.zeros((len(points), len(sizes)), dtype=bool)
    is_promising = np.arange(len(sizes))[None] < n_groups[:, None]
    np.put_along_axis(chosen, ranked, is_promising, axis=1)
    n_taken = int(CANDIDATE_FACTOR * n_neighbors)
    best = np.full((len(points), 2 * n_taken), np.inf, dtype=np.float32)
    candidates = np.zeros(best.shape, dtype=np.intp)
    for group in np.flatnonzero(chosen.any(axis=0)):
        frames = np.flatnonzero(chosen[:, group])
        rows = slice(index.starts[group], index.starts[group + 1])
        relative = _relative_distances(
            points[frames], weights[frames], index.points[rows], index.squares[rows]
        )
        _merge_best(best, candidates, frames, relative, int(rows.start), n_taken)
    return _sort_candidates(index, points, weights, candidates[:, :n_taken], n_neighbors)


def _merge_best(
    best: Single,
    candidates: Integers,
    frames: Integers,
    relative: Single,
    start: int,
    n_taken: int,
) -> None:
    """Merge the best of one group into the best so far, which are in the first half."""
    n_new = min(n_taken, relative.shape[1])
    new_candidates = np.argpartition(relative, n_new - 1, axis=1)[:, :n_new]
    squares, indices = best[frames], candidates[frames]
    squares[:, n_taken : n_taken + n_new] = np.take_along_axis(relative, new_candidates, axis=1)
    squares[:, n_taken + n_new :] = np.inf
    indices[:, n_taken : n_taken + n_new] = new_candidates + start
    best_columns = np.argpartition(squares, n_taken - 1, axis=1)
    best[frames] = np.take_along_axis(squares, best_columns, axis=1)
    candidates[frames] = np.take_along_axis(indices, best_columns, axis=1)


def _expected_distances(index: PostureIndex, points: Single, weights: Single) -> Single:
    """Return the minimum distance to expect in each group, shape (n_frames, n_groups)."""
    result = np.zeros((len(points), len(index.centers)), dtype=np.float32)
    for joint in np.flatnonzero(weights.any(axis=0)):
        distance = squared_distances(points[:, joint], index.centers[:, joint])
        np.sqrt(distance, out=distance)
        distance -= index.radii[:, joint]
        np.maximum(distance, 0.0, out=distance)
        distance *= distance
        distance *= weights[:, [joint]]
        result += distance
    return result
