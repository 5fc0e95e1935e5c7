"""Peers of retrieval that forget most of the order: covariances, and bags of words."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .complete_postures import CompletePostures, learn_complete_postures, resampled

WINDOWS = ((0.0, 1.0), (0.0, 0.5), (0.25, 0.75), (0.5, 1.0))
"""Two levels of [HTGE13], overlapping, as fractions of the clip."""


@dataclass(frozen=True)
class Covariances:
    """Covariances of joint positions over a clip and its halves.

    [HTGE13] Hussein, Torki, Gowayyed, El-Saban (2013). Human action recognition using a
    temporal hierarchy of covariance descriptors on 3D joint locations. IJCAI. With `ridge`,
    the logarithms of the matrices (log-Euclidean metric) instead of themselves.
    """

    ridge: float | None = None
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "DescribedLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        rows = np.stack([self.descriptor(frames) for frames in found])
        return DescribedLibrary(complete, rows, self, "euclidean")

    def descriptor(self, frames: Array) -> Array:
        samples = resampled(frames[:, 3:], max(len(frames), 8))
        upper = np.triu_indices(samples.shape[1])
        parts = []
        for first, last in WINDOWS:
            cut = samples[int(first * len(samples)) : round(last * len(samples))]
            matrix = np.cov(cut.T)
            if self.ridge is not None:
                values, axes = np.linalg.eigh(matrix + self.ridge * np.eye(len(matrix)))
                matrix = axes * np.log(values) @ axes.T
            parts.append(matrix[upper] * np.where(upper[0] == upper[1], 1.0, np.sqrt(2.0)))
        return np.concatenate(parts)


@dataclass(frozen=True)
class BagOfWords:
    """How often each of some typical postures comes, rare ones weighted up (tf-idf)."""

    n_words: int = 128
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "DescribedLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        frames = np.concatenate(found)
        words = KMeans(self.n_words, n_init=1, random_state=0).fit(frames).cluster_centers_
        counts = np.stack([_counts(each, words) for each in found])
        rare = np.log(len(found) / np.maximum((counts > 0.0).sum(axis=0), 1))
        bag = Bag(words, rare)
        return DescribedLibrary(complete, counts * rare, bag, "cosine")


@dataclass(frozen=True, eq=False)
class Bag:
    words: Array
    rare: Array

    def descriptor(self, frames: Array) -> Array:
        return _counts(frames, self.words) * self.rare


@dataclass(frozen=True, eq=False)
class DescribedLibrary:
    """Clips as vectors."""

    complete: CompletePostures
    rows: Array
    how: Covariances | Bag
    metric: str

    def describe(self, tracks: Tracks) -> Array:
        return self.how.descriptor(self.complete(tracks))

    def distances(self, query: Array, allowed: Flags) -> Array:
        found = cdist(query[None], self.rows, self.metric)[0]
        return np.where(np.isfinite(found), found, np.inf)


def _counts(frames: Array, words: Array) -> Array:
    nearest = cdist(frames, words).argmin(axis=1)
    return np.bincount(nearest, minlength=len(words)) / len(frames)
