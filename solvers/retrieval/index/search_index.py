"""All blocks of a library as one index, and what of it does not depend on the query."""

from collections.abc import Collection, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .index_block import IndexBlock
from .reranking import pairwise_warping_costs
from .segments import MEAN_POSTURE_WEIGHT, weight_mean_posture

Single = NDArray[np.float32]
Numbers = NDArray[np.int64]

MAX_PAIRWISE_SPANS = 1000
"""Spans of a library in which each is compared with each, once, for all queries to come."""


class SearchIndex:
    """Spans of clips that are still there; a library keeps it until it changes."""

    def __init__(self, blocks: Sequence[tuple[IndexBlock, NDArray[np.bool_]]]) -> None:
        self._blocks = [block for block, _ in blocks]
        self._alive = [alive for _, alive in blocks]
        self._starts = np.cumsum([0, *(block.n_spans for block in self._blocks)])

    @cached_property
    def clips(self) -> Numbers:
        """Number of the clip that each span is of."""
        return np.concatenate([block.clips for block in self._blocks])

    @cached_property
    def frames(self) -> NDArray[np.int32]:
        """First frame of each span and the one after its last, at 20 Hz."""
        return np.concatenate([block.frames for block in self._blocks])

    @cached_property
    def _by_clip(self) -> tuple[Numbers, Numbers, Numbers]:
        """Spans of clips that are there, where those of each clip begin, and the clips."""
        alive = np.flatnonzero(np.concatenate(self._alive))
        order = alive[np.argsort(self.clips[alive], kind="stable")]
        starts = np.flatnonzero(np.diff(self.clips[order], prepend=-1))
        return order, starts, self.clips[order[starts]]

    def common(self, query: Single) -> Single:
        """Return how much of its words each span has in common, shape (n_spans,), 0 to 1."""
        return np.concatenate([block.common(query) for block in self._blocks])

    def best_spans(self, apart: Single, ignore: Collection[int]) -> tuple[Single, Numbers]:
        """Return the least distance of each clip, and the number of the span that has it."""
        order, starts, numbers = self._by_clip
        if not len(starts):
            return np.zeros(0, dtype=np.float32), order
        if len(starts) < len(order):
            least = np.minimum.reduceat(apart[order], starts)
            sizes = np.diff(starts, append=len(order))
            is_least = np.flatnonzero(apart[order] == np.repeat(least, sizes))
            order = order[is_least[np.searchsorted(is_least, starts)]]
        if ignore:
            left_out = np.fromiter(ignore, dtype=np.int64, count=len(ignore))
            places = np.minimum(np.searchsorted(numbers, left_out), len(numbers) - 1)
            told = np.ones(len(order), dtype=np.bool_)
            told[places[numbers[places] == left_out]] = False
            order = order[told]
        return apart[order], order

    def steps(self, spans: Numbers) -> Single:
        """Return summaries of these spans, shape (n, 16, 5, 8), copied."""
        if len(self._blocks) == 1:
            return self._blocks[0].steps(spans)
        of = np.searchsorted(self._starts, spans, side="right") - 1
        steps = np.empty((len(spans), *self._blocks[0].summaries.shape[1:]), dtype=np.float32)
        for one in np.unique(of):
            steps[of == one] = self._blocks[one].steps(spans[of == one] - self._starts[one])
        return steps

    def between(self, spans: Numbers) -> Single | None:
        """Return how far these are from each other, all parts of the body alike, shape (n, n).

        None in a library that is too large to keep that of all.
        """
        if len(self.clips) > MAX_PAIRWISE_SPANS:
            return None
        return np.asarray(self._between_all[np.ix_(spans, spans)])

    @cached_property
    def _between_all(self) -> Single:
        steps = weight_mean_posture(self.steps(np.arange(len(self.clips))), MEAN_POSTURE_WEIGHT)
        return pairwise_warping_costs(steps.reshape(*steps.shape[:2], -1))
