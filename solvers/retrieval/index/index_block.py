"""Spans of clips that were indexed together, ready to be searched."""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..postures import N_PARTS
from .posting_lists import PostingLists, build_posting_lists
from .segments import N_CUBES, N_STEPS, Segments
from .vocabulary import N_AXES

MAX_POSTINGS = 1_000_000
"""That are read of a block for one query."""
N_EXACT_SPANS = 512
"""Spans of a large block whose histograms are compared exactly."""
STEP_SHAPE = (N_STEPS, N_PARTS, N_AXES)


@dataclass(frozen=True, eq=False)
class IndexBlock:
    """Spans of some clips of a library; it is never changed.

    Attributes
    ----------
    clips : int64, shape (n_spans,)
        Number of the clip that each span is of.
    frames : int32, shape (n_spans, 2)
        At 20 Hz.
    histograms : uint8, shape (n_spans, n_bins)
        Of words, for each part of the body and each stretch of time (`Segments`).
    summaries : float16, shape (n_spans, 16, 5, 8)
    postings : PostingLists
    """

    clips: NDArray[np.int64]
    frames: NDArray[np.int32]
    histograms: NDArray[np.uint8]
    summaries: NDArray[np.float16]
    postings: PostingLists

    @property
    def n_spans(self) -> int:
        """How many spans there are."""
        return len(self.clips)

    @cached_property
    def _numbers(self) -> NDArray[np.float32]:
        """Histograms of a small block, ready to be multiplied."""
        return self.histograms.astype(np.float32)

    @cached_property
    def _steps(self) -> NDArray[np.float32]:
        return self.summaries.astype(np.float32)

    def steps(self, rows: NDArray[np.int64]) -> NDArray[np.float32]:
        """Return summaries of some spans, (n, 16, 5, 8); those of small blocks are kept."""
        if self.histograms.size <= MAX_POSTINGS:
            return self._steps[rows]
        return self.summaries[rows].astype(np.float32)

    def common(self, query: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return how much each span has in common with histograms, shape (n_spans,).

        All is compared in a small block; in a large one, the inverted index says which spans
        are compared exactly, and about how much the others have in common.

        Parameters
        ----------
        query : shape (n_bins,)
        """
        if self.histograms.size <= MAX_POSTINGS:
            return np.asarray(self._numbers @ query)
        common = self.postings.scores(query, MAX_POSTINGS)
        best = np.argpartition(-common, min(N_EXACT_SPANS, self.n_spans - 1))[:N_EXACT_SPANS]
        common[best] = self.histograms[best].astype(np.float32) @ query
        return common


def build_block(clips: list[int], described: list[Segments]) -> IndexBlock:
    """Put the spans of clips into one block."""
    sizes = [len(spans.frames) for spans in described]
    histograms = np.concatenate([spans.histograms for spans in described])
    flat = histograms.reshape(len(histograms), -1)
    return IndexBlock(
        np.repeat(np.array(clips, dtype=np.int64), sizes),
        np.concatenate([spans.frames for spans in described]),
        flat,
        np.concatenate([spans.summaries for spans in described]),
        build_posting_lists(flat),
    )


def merge_blocks(blocks: list[IndexBlock], alive: NDArray[np.int64]) -> IndexBlock:
    """Put blocks together, without the spans of clips that are no longer `alive`."""
    kept = [np.isin(block.clips, alive) for block in blocks]
    columns = {
        item.name: np.concatenate([
            getattr(block, item.name)[keep] for block, keep in zip(blocks, kept, strict=True)
        ])
        for item in fields(IndexBlock)
        if item.name != "postings"
    }  # fmt: skip
    return IndexBlock(**columns, postings=build_posting_lists(columns["histograms"]))


def block_arrays(block: IndexBlock) -> dict[str, bytes]:
    """Return what is stored of a block, by the names of the columns."""
    return {
        "clips": block.clips.astype("<i8").tobytes(),
        "frames": block.frames.astype("<i4").tobytes(),
        "histograms": block.histograms.tobytes(),
        "summaries": block.summaries.astype("<f2").tobytes(),
        "starts": block.postings.starts.astype("<i8").tobytes(),
        "spans": block.postings.spans.astype("<i4").tobytes(),
        "weights": block.postings.weights.tobytes(),
    }


def block_from_arrays(stored: dict[str, bytes], n_words: int) -> IndexBlock:
    """Return the block that `block_arrays` told.

    Raises
    ------
    ValueError
        The sizes do not fit each other, or a number points beyond them.
    """
    n_bins = N_PARTS * N_CUBES * n_words
    clips = np.frombuffer(stored["clips"], "<i8")
    n_spans = len(clips)
    starts = np.frombuffer(stored["starts"], "<i8").reshape(n_bins + 1)
    spans = np.frombuffer(stored["spans"], "<i4")
    weights = np.frombuffer(stored["weights"], np.uint8)
    beyond = len(spans) and not (spans.min() >= 0 and spans.max() < n_spans)
    if beyond or len(weights) != len(spans) or starts[0] or starts[-1] != len(spans):
        raise ValueError("The index does not fit itself.")
    if (np.diff(starts) < 0).any():
        raise ValueError("The index is not in order.")
    frames = np.frombuffer(stored["frames"], "<i4").reshape(n_spans, 2)
    summaries = np.frombuffer(stored["summaries"], "<f2").reshape(n_spans, *STEP_SHAPE)
    if (frames[:, 0] < 0).any() or (frames[:, 0] >= frames[:, 1]).any():
        raise ValueError("A span of the index has no frames.")
    if not np.isfinite(summaries).all():
        raise ValueError("A summary of the index is not finite.")
    return IndexBlock(
        clips,
        frames,
        np.frombuffer(stored["histograms"], np.uint8).reshape(n_spans, n_bins),
        summaries,
        PostingLists(starts, spans, weights, n_spans),
    )
