"""Segments of clips that were indexed together, ready to be searched."""

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ..postures import N_PARTS
from .clip_segments import N_CUBES, N_STEPS, Segments
from .posting_lists import PostingLists, build_posting_lists
from .vocabulary import N_AXES

MAX_POSTINGS = 1_000_000
"""Postings of one block that a query reads at most. It bounds the run time: smaller blocks
compare all segments."""
N_EXACT_SEGMENTS = 512
"""Segments of a large block whose histograms are compared exactly. It bounds the run time."""
STEP_SHAPE = (N_STEPS, N_PARTS, N_AXES)


@dataclass(frozen=True, eq=False)
class IndexBlock:
    """Immutable index of the segments of some clips.

    Attributes
    ----------
    clips : int64, shape (n_segments,)
        Clip number of each segment.
    frames : int32, shape (n_segments, 2)
        First frame and the frame after the last, at 20 Hz.
    histograms : uint8, shape (n_segments, n_bins)
        Codeword counts for each body part and time interval (`Segments`).
    summaries : float16, shape (n_segments, 16, 5, 8)
    postings : PostingLists
    """

    clips: NDArray[np.int64]
    frames: NDArray[np.int32]
    histograms: NDArray[np.uint8]
    summaries: NDArray[np.float16]
    postings: PostingLists

    @property
    def n_segments(self) -> int:
        """Number of segments."""
        return len(self.clips)

    @cached_property
    def _numbers(self) -> NDArray[np.float32]:
        """Histograms of a small block as floats."""
        return self.histograms.astype(np.float32)

    @cached_property
    def _steps(self) -> NDArray[np.float32]:
        return self.summaries.astype(np.float32)

    def steps(self, rows: NDArray[np.int64]) -> NDArray[np.float32]:
        """Return the summaries of segments, (n, 16, 5, 8); small blocks cache them."""
        if self.histograms.size <= MAX_POSTINGS:
            return self._steps[rows]
        return self.summaries[rows].astype(np.float32)

    def similarities(self, query: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the histogram similarity of each segment to a query, shape (n_segments,).

        A small block compares all segments. In a large block, the inverted index estimates all
        similarities and selects the segments for exact comparison.

        Parameters
        ----------
        query : shape (n_bins,)
        """
        if self.histograms.size <= MAX_POSTINGS:
            return np.asarray(self._numbers @ query)
        similarities = self.postings.scores(query, MAX_POSTINGS)
        best = np.argpartition(-similarities, min(N_EXACT_SEGMENTS, self.n_segments - 1))[
            :N_EXACT_SEGMENTS
        ]
        similarities[best] = self.histograms[best].astype(np.float32) @ query
        return similarities


def build_block(clips: list[int], described: list[Segments]) -> IndexBlock:
    """Build one block from the segments of clips."""
    sizes = [len(segments.frames) for segments in described]
    histograms = np.concatenate([segments.histograms for segments in described])
    flat = histograms.reshape(len(histograms), -1)
    return IndexBlock(
        np.repeat(np.array(clips, dtype=np.int64), sizes),
        np.concatenate([segments.frames for segments in described]),
        flat,
        np.concatenate([segments.summaries for segments in described]),
        build_posting_lists(flat),
    )


def merge_blocks(blocks: list[IndexBlock], alive: NDArray[np.int64]) -> IndexBlock:
    """Merge blocks; keep the segments of clips whose numbers are in `alive`, (n_clips,)."""
    kept = [np.isin(block.clips, alive) for block in blocks]
    columns = {
        item.name: np.concatenate([
            getattr(block, item.name)[mask] for block, mask in zip(blocks, kept, strict=True)
        ])
        for item in fields(IndexBlock)
        if item.name != "postings"
    }  # fmt: skip
    return IndexBlock(**columns, postings=build_posting_lists(columns["histograms"]))


def block_arrays(block: IndexBlock) -> dict[str, bytes]:
    """Return the stored bytes of a block by column name."""
    return {
        "clips": block.clips.astype("<i8").tobytes(),
        "frames": block.frames.astype("<i4").tobytes(),
        "histograms": block.histograms.tobytes(),
        "summaries": block.summaries.astype("<f2").tobytes(),
        "starts": block.postings.starts.astype("<i8").tobytes(),
        "spans": block.postings.segments.astype("<i4").tobytes(),
        "weights": block.postings.weights.tobytes(),
    }


def block_from_arrays(stored: dict[str, bytes], n_words: int) -> IndexBlock:
    """Return the block from the bytes of `block_arrays`.

    Raises
    ------
    ValueError
        The sizes are inconsistent, or an index is out of range.
    """
    n_bins = N_PARTS * N_CUBES * n_words
    clips = np.frombuffer(stored["clips"], "<i8")
    n_segments = len(clips)
    starts = np.frombuffer(stored["starts"], "<i8").reshape(n_bins + 1)
    segments = np.frombuffer(stored["spans"], "<i4")
    weights = np.frombuffer(stored["weights"], np.uint8)
    out_of_range = len(segments) and not (segments.min() >= 0 and segments.max() < n_segments)
    if (
        out_of_range
        or len(weights) != len(segments)
        or starts[0]
        or starts[-1] != len(segments)
    ):
        raise ValueError("The sizes of the index are inconsistent.")
    if (np.diff(starts) < 0).any():
        raise ValueError("The posting lists of the index are not in order.")
    frames = np.frombuffer(stored["frames"], "<i4").reshape(n_segments, 2)
    summaries = np.frombuffer(stored["summaries"], "<f2").reshape(n_segments, *STEP_SHAPE)
    if (frames[:, 0] < 0).any() or (frames[:, 0] >= frames[:, 1]).any():
        raise ValueError("A span of the index has no frames.")
    if not np.isfinite(summaries).all():
        raise ValueError("A summary of the index is not finite.")
    return IndexBlock(
        clips,
        frames,
        np.frombuffer(stored["histograms"], np.uint8).reshape(n_segments, n_bins),
        summaries,
        PostingLists(starts, segments, weights, n_segments),
    )
