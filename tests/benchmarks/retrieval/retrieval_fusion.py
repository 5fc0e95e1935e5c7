"""Several methods as one, and the library's own likenesses: manifold ranking."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .retrieval_protocol import Method, Prepared

PASSED_FRACTION = 0.95
"""Fraction of its score that a clip passes on (alpha of [ZBL04])."""


@dataclass(frozen=True)
class Fused:
    """The sum of distances of several methods, each with mean 0 and deviation 1 over clips.

    With `n_neighbors`, manifold ranking [ZBL04] comes after: each clip is linked to that many
    nearest, the query's own nearest get score 1, and all pass on their scores.

    [ZBL04] Zhou, Weston, Gretton, Bousquet, Schoelkopf (2004). Ranking on data manifolds. NIPS.
    """

    methods: tuple[Method, ...]
    n_neighbors: int = 0

    def prepare(self, clips: Sequence[Tracks]) -> "FusedLibrary":
        prepared = [method.prepare(clips) for method in self.methods]
        between = np.zeros((len(clips), len(clips)))
        fused = FusedLibrary(prepared, between, self.n_neighbors)
        if self.n_neighbors:
            allowed = ~np.eye(len(clips), dtype=bool)
            for index, clip in enumerate(clips):
                between[index] = fused.plain(fused.describe(clip), allowed[index])
        return fused


@dataclass(frozen=True, eq=False)
class FusedLibrary:
    prepared: list[Prepared]
    between: Array
    n_neighbors: int

    def describe(self, tracks: Tracks) -> list[Any]:
        return [each.describe(tracks) for each in self.prepared]

    def distances(self, query: list[Any], allowed: Flags) -> Array:
        plain = self.plain(query, allowed)
        if not self.n_neighbors:
            return plain
        indices = np.flatnonzero(allowed)
        result = np.full(len(allowed), np.inf)
        within = self.between[np.ix_(indices, indices)]
        scores_ = manifold_ranking(within, plain[indices], self.n_neighbors)
        # Clips that nothing reaches come last, in the order of plain distances.
        result[indices] = -scores_ + 1e-6 * plain[indices]
        return result

    def plain(self, query: list[Any], allowed: Flags) -> Array:
        total = np.zeros(len(allowed))
        for each, described in zip(self.prepared, query, strict=True):
            distances_ = each.distances(described, allowed)
            allowed_distances = distances_[allowed]
            total += (distances_ - allowed_distances.mean()) / max(
                float(allowed_distances.std()), 1e-12
            )
        return total


def manifold_ranking(between: Array, query: Array, n_neighbors: int) -> Array:
    """Return the score of each clip.

    Parameters
    ----------
    between : shape (n_clips, n_clips)
        Distances; that of a clip to itself is not looked at.
    query : shape (n_clips,)
    """
    n_clips, few = len(query), min(n_neighbors, len(query) - 1)
    distances_ = np.where(np.eye(n_clips, dtype=bool), np.inf, between)
    nearest = np.argpartition(distances_, few - 1, axis=1)[:, :few]
    links = np.zeros((n_clips, n_clips))
    np.put_along_axis(links, nearest, 1.0, axis=1)
    links = np.maximum(links, links.T)
    size = np.sqrt(links.sum(axis=1))
    query_weights = np.zeros(n_clips)
    query_weights[np.argsort(query)[:n_neighbors]] = 1.0
    spread = np.eye(n_clips) - PASSED_FRACTION * links / np.outer(size, size)
    return np.asarray(np.linalg.solve(spread, query_weights))
