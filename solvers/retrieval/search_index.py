"""All blocks of a library as one index, and what of it does not depend on the query."""

from collections.abc import Collection, Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .index_block import IndexBlock

Single = NDArray[np.float32]
Numbers = NDArray[np.int64]


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
    def _by_clip(self) -> tuple[Numbers, Numbers]:
        """Spans of clips that are there, clip by clip, and where those of each clip begin."""
        alive = np.flatnonzero(np.concatenate(self._alive))
        order = alive[np.argsort(self.clips[alive], kind="stable")]
        return order, np.flatnonzero(np.diff(self.clips[order], prepend=-1))

    def common(self, query: Single) -> Single:
        """Return how much of its words each span has in common, shape (n_spans,), 0 to 1."""
        return np.concatenate([block.common(query) for block in self._blocks])

    def best_spans(self, apart: Single, ignore: Collection[int]) -> tuple[Single, Numbers]:
        """Return the least distance of each clip, and the number of the span that has it."""
        order, starts = self._by_clip
        if not len(starts):
            return np.zeros(0, dtype=np.float32), order
        if len(starts) < len(order):
            least = np.minimum.reduceat(apart[order], starts)
            sizes = np.diff(starts, append=len(order))
            is_least = np.flatnonzero(apart[order] == np.repeat(least, sizes))
            order = order[is_least[np.searchsorted(is_least, starts)]]
        if ignore:
            order = order[~np.isin(self.clips[order], list(ignore))]
        return apart[order], order

    def stored(self, spans: Numbers) -> tuple[NDArray[np.uint8], Single]:
        """Return histograms and summaries of these spans, copied."""
        if len(self._blocks) == 1:
            return self._blocks[0].histograms[spans], self._blocks[0].steps(spans)
        of = np.searchsorted(self._starts, spans, side="right") - 1
        first = self._blocks[0]
        histograms = np.empty((len(spans), first.histograms.shape[1]), dtype=np.uint8)
        summaries = np.empty((len(spans), *first.summaries.shape[1:]), dtype=np.float32)
        for one in np.unique(of):
            rows = spans[of == one] - self._starts[one]
            histograms[of == one] = self._blocks[one].histograms[rows]
            summaries[of == one] = self._blocks[one].steps(rows)
        return histograms, summaries
