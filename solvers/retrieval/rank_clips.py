"""The order of a library's clips for a query: words first, then warping, then the best ask."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from .body_parts import N_PARTS
from .find_settings import FindSettings
from .index_block import IndexBlock
from .span_warping import frame_distances, warping_costs
from .spans import FULL, N_CUBES, Spans

Single = NDArray[np.float32]
Numbers = NDArray[np.int64]

CLIPS_PER_WITNESS = 20
"""Clips for each match that is asked as well: the five best of six are not all alike."""


@dataclass(frozen=True, eq=False)
class SpanQuery:
    """Spans that ask, n of them.

    Attributes
    ----------
    histograms : shape (n, n_bins)
        With the weights of the parts of the body; the product with those of a span is 1 for
        the same words, 0 where there is none in common.
    summaries : shape (n, 16, 40)
        With the square roots of the weights.
    weights : shape (5,)
    """

    histograms: Single
    summaries: Single
    weights: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        histograms: NDArray[np.uint8],
        summaries: NDArray[np.float16],
        weights: NDArray[np.float64],
    ) -> Self:
        """Let stored spans ask, with these weights of the parts of the body."""
        parted = histograms.reshape(len(histograms), N_PARTS, -1).astype(np.float32)
        share = weights.astype(np.float32)[:, None] / (FULL**2 * N_PARTS * N_CUBES)
        return cls(
            (parted * share).reshape(len(histograms), -1),
            weighted(summaries, weights),
            weights,
        )


@dataclass(frozen=True, eq=False)
class Ranking:
    """Clips in the order of how like a query they are.

    Attributes
    ----------
    clips : int64, shape (n,)
        Their numbers, best first.
    frames : int32, shape (n, 2)
        Of each the span that is most like the query, at 20 Hz.
    distances : shape (n,)
        0 for the same motion; what has nothing in common is about 1.5 apart.
    """

    clips: Numbers
    frames: NDArray[np.int32]
    distances: Single


def weighted(summaries: NDArray[np.float16], weights: NDArray[np.float64]) -> Single:
    """Return summaries, (n, 16, 5, 8), as vectors with the parts weighted, (n, 16, 40)."""
    scaled = summaries.astype(np.float32) * np.sqrt(weights).astype(np.float32)[:, None]
    return scaled.reshape(*summaries.shape[:2], -1)


def rank_clips(
    query: Spans,
    weights: NDArray[np.float64],
    blocks: Sequence[tuple[IndexBlock, NDArray[np.bool_]]],
    settings: FindSettings,
    ignore: Sequence[int] = (),
) -> Ranking:
    """Rank all clips of the index by the first span of a query."""
    index = _Index(blocks, ignore)
    asked = SpanQuery.of(query.histograms[:1], query.summaries[:1], weights)
    apart, spans = index.best_spans(1.0 - index.common(asked))
    near = np.argsort(apart, kind="stable")[: settings.n_warped]
    apart = _with_courses(apart, near, index.warped(asked, spans[near])[0], settings.warping)
    order = np.argsort(apart, kind="stable")
    n_alike = min(settings.n_alike, len(order) // CLIPS_PER_WITNESS)
    if n_alike and len(near):
        best = order[:n_alike]
        others = SpanQuery.of(*index.stored(spans[best]), weights)
        courses = index.warped(others, spans[near]).mean(axis=0)
        alike = 1.0 - index.common(others)[spans]
        beside = _with_courses(alike, near, courses, settings.warping)
        apart = (apart + len(best) * beside) / (1 + len(best))
        order = np.argsort(apart, kind="stable")
    spans = spans[order]
    return Ranking(index.clips[spans], index.frames[spans], apart[order])


def _with_courses(apart: Single, near: Numbers, courses: Single, weight: float) -> Single:
    """Add what warping costs; clips that were not warped count as the worst of those."""
    worst = courses.max() if len(courses) else np.float32(0.0)
    total = apart + np.float32(weight) * worst
    total[near] = apart[near] + np.float32(weight) * courses
    return total


class _Index:
    """All blocks as one, less the clips that are gone or not asked for."""

    def __init__(
        self,
        blocks: Sequence[tuple[IndexBlock, NDArray[np.bool_]]],
        ignore: Sequence[int],
    ) -> None:
        self._blocks = [block for block, _ in blocks]
        self._starts = np.cumsum([0, *(block.n_spans for block in self._blocks)])
        self.clips = np.concatenate([block.clips for block in self._blocks])
        self.frames = np.concatenate([block.frames for block in self._blocks])
        self._alive = np.concatenate([alive for _, alive in blocks])
        for number in ignore:
            self._alive = self._alive & (self.clips != number)

    def common(self, query: SpanQuery) -> Single:
        """Return how much of the words each span has in common, shape (n_spans,), 0 to 1."""
        asked = query.histograms.mean(axis=0)
        return np.concatenate([block.common(asked) for block in self._blocks])

    def best_spans(self, apart: Single) -> tuple[Single, Numbers]:
        """Return the least distance of each clip, and the number of the span that has it."""
        alive = np.flatnonzero(self._alive)
        order = alive[np.lexsort((apart[alive], self.clips[alive]))]
        first = np.r_[True, np.diff(self.clips[order]) > 0] if len(order) else []
        spans = order[first]
        return apart[spans], spans

    def stored(self, spans: Numbers) -> tuple[NDArray[np.uint8], NDArray[np.float16]]:
        """Return histograms and summaries of spans."""
        of = np.searchsorted(self._starts, spans, side="right") - 1
        rows = spans - self._starts[of]
        histograms = [
            self._blocks[one].histograms[row] for one, row in zip(of, rows, strict=True)
        ]
        summaries = [
            self._blocks[one].summaries[row] for one, row in zip(of, rows, strict=True)
        ]
        return np.stack(histograms), np.stack(summaries)

    def warped(self, query: SpanQuery, spans: Numbers) -> Single:
        """Return what it costs to warp each asking span onto these, shape (n, n_spans)."""
        if not len(spans):
            return np.zeros((len(query.summaries), 0), dtype=np.float32)
        courses = weighted(self.stored(spans)[1], query.weights)
        return warping_costs(frame_distances(query.summaries, courses))
