"""Search all blocks of a library as one index."""

from collections.abc import Collection, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...arrays import MAX_BLOCK_VALUES, Integers, Single
from .clip_segments import MEAN_POSTURE_WEIGHT, weight_mean_posture
from .index_block import IndexBlock
from .reranking import pairwise_warping_costs


class SearchIndex:
    """Segments of clips that exist; a library caches it until it changes."""

    def __init__(self, blocks: Sequence[tuple[IndexBlock, NDArray[np.bool_]]]) -> None:
        self._blocks = [block for block, _ in blocks]
        self._alive = [alive for _, alive in blocks]
        self._starts = np.cumsum([0, *(block.n_segments for block in self._blocks)])

    @property
    def n_segments(self) -> int:
        """Number of segments, also those of removed clips."""
        return int(self._starts[-1])

    @cached_property
    def clips(self) -> Integers:
        """Clip number of each segment."""
        return np.concatenate([block.clips for block in self._blocks])

    @cached_property
    def frames(self) -> NDArray[np.int32]:
        """First frame of each segment and the frame after its last, at 20 Hz."""
        return np.concatenate([block.frames for block in self._blocks])

    @cached_property
    def _by_clip(self) -> tuple[Integers, Integers, Integers]:
        """Segments of clips that exist, the start of each clip, and the clips."""
        alive = np.flatnonzero(np.concatenate(self._alive))
        order = alive[np.argsort(self.clips[alive], kind="stable")]
        starts = np.flatnonzero(np.diff(self.clips[order], prepend=-1))
        return order, starts, self.clips[order[starts]]

    def similarities(self, query: Single) -> Single:
        """Return the histogram similarity of each segment, shape (n_segments,), 0 to 1."""
        return np.concatenate([block.similarities(query) for block in self._blocks])

    def best_segments(
        self, distances: Single, ignore: Collection[int]
    ) -> tuple[Single, Integers]:
        """Return the minimum distance of each clip, and the segment with this distance.

        `distances` has the shape (n_segments,); clips to ignore are left out.
        """
        order, starts, numbers = self._by_clip
        if not len(starts):
            return np.zeros(0, dtype=np.float32), order
        if len(starts) < len(order):
            minima = np.minimum.reduceat(distances[order], starts)
            sizes = np.diff(starts, append=len(order))
            is_minimum = np.flatnonzero(distances[order] == np.repeat(minima, sizes))
            order = order[is_minimum[np.searchsorted(is_minimum, starts)]]
        if ignore:
            ignored = np.fromiter(ignore, dtype=np.int64, count=len(ignore))
            indices = np.minimum(np.searchsorted(numbers, ignored), len(numbers) - 1)
            keep = np.ones(len(order), dtype=np.bool_)
            keep[indices[numbers[indices] == ignored]] = False
            order = order[keep]
        return distances[order], order

    def steps(self, segments: Integers) -> Single:
        """Return summaries of these segments, shape (n, 16, 5, 8), copied."""
        if len(self._blocks) == 1:
            return self._blocks[0].steps(segments)
        blocks = np.searchsorted(self._starts, segments, side="right") - 1
        steps = np.empty(
            (len(segments), *self._blocks[0].summaries.shape[1:]), dtype=np.float32
        )
        for block in np.unique(blocks):
            rows = segments[blocks == block] - self._starts[block]
            steps[blocks == block] = self._blocks[block].steps(rows)
        return steps

    def pairwise_distances(self, segments: Integers) -> Single | None:
        """Return the distances between segments with equal part weights, shape (n, n).

        Return None for a library that is too large to cache all distances.
        """
        if not may_cache_distances(self.n_segments):
            return None
        return np.asarray(self._all_distances[np.ix_(segments, segments)])

    @cached_property
    def _all_distances(self) -> Single:
        return default_distances(self.steps(np.arange(len(self.clips))))


def may_cache_distances(n_segments: int) -> bool:
    """Whether so many segments are few enough to keep the distances between all of them."""
    return n_segments**2 <= MAX_BLOCK_VALUES


def default_distances(steps: Single) -> Single:
    """Return the distances between segments with equal part weights, from their summaries."""
    weighted = weight_mean_posture(steps, MEAN_POSTURE_WEIGHT)
    return pairwise_warping_costs(weighted.reshape(*weighted.shape[:2], -1))
