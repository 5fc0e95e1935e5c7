"""An inverted index: for each word, the spans in which it is said, and how loud."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Single = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class PostingLists:
    """Spans by words.

    Attributes
    ----------
    starts : int64, shape (n_bins + 1,)
        Where the list of each bin begins in the other two.
    spans : int32, shape (n_postings,)
    weights : uint8, shape (n_postings,)
    n_spans : int
    """

    starts: NDArray[np.int64]
    spans: NDArray[np.int32]
    weights: NDArray[np.uint8]
    n_spans: int

    def scores(self, query: Single, most: int) -> Single:
        """Return how much each span has in common with the query, shape (n_spans,).

        Bins are visited from the weightiest on, until `most` postings were read: what is
        left then tells little, and a large library costs no more than a middling one.

        Parameters
        ----------
        query : shape (n_bins,)
        """
        order = np.argsort(-query)[: np.count_nonzero(query)]
        sizes = (self.starts[1:] - self.starts[:-1])[order]
        n_read = max(int(np.searchsorted(np.cumsum(sizes), most)), 1)
        order, sizes = order[:n_read], sizes[:n_read]
        places = np.repeat(self.starts[order] - np.r_[0, np.cumsum(sizes)[:-1]], sizes)
        places += np.arange(len(places))
        loud = self.weights[places] * np.repeat(query[order], sizes)
        told = np.bincount(self.spans[places], loud, minlength=self.n_spans)
        return np.asarray(told, dtype=np.float32)


def build_posting_lists(histograms: NDArray[np.uint8]) -> PostingLists:
    """Invert histograms, shape (n_spans, n_bins)."""
    bins, spans = np.nonzero(histograms.T)
    starts = np.searchsorted(bins, np.arange(histograms.shape[1] + 1))
    return PostingLists(
        starts.astype(np.int64),
        spans.astype(np.int32),
        histograms[spans, bins],
        len(histograms),
    )
