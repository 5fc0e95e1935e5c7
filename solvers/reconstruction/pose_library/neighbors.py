"""The postures of a library that are nearest to an observed one, joint by joint as trusted."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress, unwatched
from ..joint_rotations import BodyPostures
from ..residual_correction import squared_distances

Array = NDArray[np.float64]
Single = NDArray[np.float32]
Indices = NDArray[np.intp]

BLOCK_FRAMES = 128
"""Frames that are looked for at once."""
CANDIDATE_FACTOR = 1.3
"""How many times more are taken by the quick sum than are returned by the exact one."""


class PostureQuery(NamedTuple):
    """What is looked for.

    Attributes
    ----------
    postures : shape (n_frames, 20, 3), metres
        NaN: not tracked.
    speeds : shape (n_frames, 20, 3), metres per second
    trust : shape (n_frames, 20)
    pace : float, seconds
        Movement over this time counts as much as the way between two postures; 0: only the
        posture counts, as in [SHJT13].
    """

    postures: Array
    speeds: Array
    trust: Array
    pace: float

    def slice(self, start: int, stop: int) -> "PostureQuery":
        """Return the frames `start` up to but without `stop`."""
        part = slice(start, stop)
        return PostureQuery(self.postures[part], self.speeds[part], self.trust[part], self.pace)


@dataclass(frozen=True, eq=False)
class PostureIndex:
    """Postures of one body, in groups of alike ones.

    Attributes
    ----------
    order : shape (n_postures,)
        Places in the library, group after group.
    starts : shape (n_groups + 1,)
        Where each group begins in `order`.
    points : float32, shape (n_postures, 40, 3)
        Positions and speeds, in that order.
    squares : float32, shape (n_postures, 40)
    centres : float32, shape (n_groups, 40, 3)
    radii : float32, shape (n_groups, 40)
        Usual way of a group's points from its centre.
    """

    order: Indices
    starts: Indices
    points: Single
    squares: Single
    centres: Single
    radii: Single


def index_postures(body: BodyPostures, groups: NDArray[np.int32]) -> PostureIndex:
    """Prepare the search among the postures of one body.

    Parameters
    ----------
    body : BodyPostures
    groups : shape (n_postures,)
        Number of the group of each; 0 for all: every posture is looked at.
    """
    order = np.argsort(groups, kind="stable")
    _, starts = np.unique(groups[order], return_index=True)
    points = np.concatenate([body.positions, body.speeds], axis=1)[order]
    sizes = np.diff(np.append(starts, len(order)))
    centres = np.add.reduceat(points, starts, axis=0) / sizes[:, None, None]
    off = points - np.repeat(centres, sizes, axis=0)
    spread = np.add.reduceat(np.einsum("nik,nik->ni", off, off), starts, axis=0)
    return PostureIndex(
        order, np.append(starts, len(order)), points,
        np.einsum("nik,nik->ni", points, points), centres.astype(np.float32),
        np.sqrt(spread / sizes[:, None]).astype(np.float32),
    )  # fmt: skip


def nearest_postures(
    index: PostureIndex,
    query: PostureQuery,
    n_neighbours: int = 30,
    *,
    n_looked_at: int = 8000,
    progress: Progress = unwatched,
) -> tuple[Indices, Array]:
    """Find the nearest postures by the weighted distance of [SHJT13], eq. 9.

    Groups of postures are looked through, the most promising first, until enough postures were
    seen; so the time hardly grows with the library. A group promises the squared way from the
    query to its centre, joint by joint as trusted, less what its points usually are away
    from it; any weights will do, so none have to be quantised as the paper proposes.

    Parameters
    ----------
    index : PostureIndex
    query : Query
    n_neighbours : int
    n_looked_at : int
        Postures compared with each frame, at least; more finds more of the true nearest.
    progress : Progress

    Returns
    -------
    places : shape (n_frames, n_neighbours)
        In the library, the nearest first; fewer where the library has fewer.
    distances : shape (n_frames, n_neighbours), square metres
    """
    n_neighbours = min(n_neighbours, len(index.order))
    n_frames = len(query.postures)
    places = np.empty((n_frames, n_neighbours), dtype=np.intp)
    distances = np.empty((n_frames, n_neighbours))
    whole = len(index.starts) == 2 or len(index.order) <= n_looked_at
    for start in range(0, n_frames, BLOCK_FRAMES):
        part = slice(start, min(start + BLOCK_FRAMES, n_frames))
        points, weights = _as_points(query.slice(part.start, part.stop))
        if whole:
            places[part], distances[part] = _search_all(index, points, weights, n_neighbours)
        else:
            found = _search_groups(index, points, weights, n_neighbours, n_looked_at)
            places[part], distances[part] = found
        progress(part.stop / n_frames, "Looking for like postures")
    return index.order[places], distances


def _as_points(query: PostureQuery) -> tuple[Single, Single]:
    """Positions and speeds without NaN, and the weight of each."""
    points = np.concatenate([query.postures, query.speeds], axis=1)
    weights = np.concatenate([query.trust, query.pace**2 * query.trust], axis=1)
    told = np.isfinite(points).all(axis=-1)
    points = np.where(told[..., None], points, 0.0)
    return points.astype(np.float32), np.where(told, weights, 0.0).astype(np.float32)


def _relative_distances(
    points: Single, weights: Single, known: Single, squares: Single
) -> Single:
    """Weighted squared ways but for what does not depend on the known, (n_frames, n_known)."""
    weighted = (points * weights[..., None]).reshape(len(points), -1)
    return np.asarray(weights @ squares.T - 2.0 * (weighted @ known.reshape(len(known), -1).T))


def _search_all(
    index: PostureIndex, points: Single, weights: Single, n_neighbours: int
) -> tuple[Indices, Array]:
    quick = _relative_distances(points, weights, index.points, index.squares)
    n_taken = min(int(CANDIDATE_FACTOR * n_neighbours), len(index.order))
    taken = np.argpartition(quick, n_taken - 1, axis=1)[:, :n_taken]
    return _sort_candidates(index, points, weights, taken, n_neighbours)


def _sort_candidates(
    index: PostureIndex, points: Single, weights: Single, taken: Indices, n_neighbours: int
) -> tuple[Indices, Array]:
    """Order candidates by their true distance."""
    off = index.points[taken] - points[:, None]
    ways = np.einsum("fnik,fnik,fi->fn", off, off, weights, optimize=False)
    best = np.argsort(ways, axis=1, kind="stable")[:, :n_neighbours]
    return np.take_along_axis(taken, best, axis=1), np.take_along_axis(ways, best, axis=1)


def _search_groups(
    index: PostureIndex, points: Single, weights: Single, n_neighbours: int, n_looked_at: int
) -> tuple[Indices, Array]:
    sizes = np.diff(index.starts)
    ranked = np.argsort(_expected_distances(index, points, weights), axis=1, kind="stable")
    seen = np.cumsum(sizes[ranked], axis=1)
    n_groups = (seen < n_looked_at).sum(axis=1) + 1
    chosen = np.zeros((len(points), len(sizes)), dtype=bool)
    first = np.arange(len(sizes))[None] < n_groups[:, None]
    np.put_along_axis(chosen, ranked, first, axis=1)
    n_taken = int(CANDIDATE_FACTOR * n_neighbours)
    best = np.full((len(points), 2 * n_taken), np.inf, dtype=np.float32)
    taken = np.zeros(best.shape, dtype=np.intp)
    for group in np.flatnonzero(chosen.any(axis=0)):
        frames = np.flatnonzero(chosen[:, group])
        span = slice(index.starts[group], index.starts[group + 1])
        quick = _relative_distances(
            points[frames], weights[frames], index.points[span], index.squares[span]
        )
        _merge_best(best, taken, frames, quick, int(span.start), n_taken)
    return _sort_candidates(index, points, weights, taken[:, :n_taken], n_neighbours)


def _merge_best(
    best: Single, taken: Indices, frames: Indices, quick: Single, start: int, n_taken: int
) -> None:
    """Merge the best of one group into the best so far, which stand in the first half."""
    n_new = min(n_taken, quick.shape[1])
    new = np.argpartition(quick, n_new - 1, axis=1)[:, :n_new]
    ways, places = best[frames], taken[frames]
    ways[:, n_taken : n_taken + n_new] = np.take_along_axis(quick, new, axis=1)
    ways[:, n_taken + n_new :] = np.inf
    places[:, n_taken : n_taken + n_new] = new + start
    kept = np.argpartition(ways, n_taken - 1, axis=1)
    best[frames] = np.take_along_axis(ways, kept, axis=1)
    taken[frames] = np.take_along_axis(places, kept, axis=1)


def _expected_distances(index: PostureIndex, points: Single, weights: Single) -> Single:
    """Return the least distance to expect in each group, shape (n_frames, n_groups)."""
    result = np.zeros((len(points), len(index.centres)), dtype=np.float32)
    for one in np.flatnonzero(weights.any(axis=0)):
        way = squared_distances(points[:, one], index.centres[:, one])
        np.sqrt(way, out=way)
        way -= index.radii[:, one]
        np.maximum(way, 0.0, out=way)
        way *= way
        way *= weights[:, [one]]
        result += way
    return result
