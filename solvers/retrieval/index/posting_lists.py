"""Inverted index: for each histogram bin, the segments with that codeword and its weight."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Single


@dataclass(frozen=True, eq=False)
class PostingLists:
    """Segments by histogram bin.

    Attributes
    ----------
    starts : int64, shape (n_bins + 1,)
        Start of the list of each bin in the other two arrays.
    segments : int32, shape (n_postings,)
    weights : uint8, shape (n_postings,)
    n_segments : int
    """

    starts: NDArray[np.int64]
    segments: NDArray[np.int32]
    weights: NDArray[np.uint8]
    n_segments: int

    def scores(self, query: Single, max_postings: int) -> Single:
        """Return the approximate similarity of each segment to the query, shape (n_segments,).

        Bins are read in order of decreasing query weight, up to `max_postings` postings. The
        remaining bins contribute little, so the cost is bounded for large libraries.

        Parameters
        ----------
        query : shape (n_bins,)
        """
        order = np.argsort(-query)[: np.count_nonzero(query)]
        sizes = (self.starts[1:] - self.starts[:-1])[order]
        n_read = max(int(np.searchsorted(np.cumsum(sizes), max_postings)), 1)
        order, sizes = order[:n_read], sizes[:n_read]
        indices = np.repeat(self.starts[order] - np.r_[0, np.cumsum(sizes)[:-1]], sizes)
        indices += np.arange(len(indices))
        products = self.weights[indices] * np.repeat(query[order], sizes)
        scores = np.bincount(self.segments[indices], products, minlength=self.n_segments)
        return np.asarray(scores, dtype=np.float32)


def build_posting_lists(histograms: NDArray[np.uint8]) -> PostingLists:
    """Invert histograms, shape (n_segments, n_bins)."""
    bins, segments = np.nonzero(histograms.T)
    starts = np.searchsorted(bins, np.arange(histograms.shape[1] + 1))
    return PostingLists(
        starts.astype(np.int64),
        segments.astype(np.int32),
        histograms[segments, bins],
        len(histograms),
    )
