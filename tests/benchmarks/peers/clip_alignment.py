"""Peers of retrieval that compare frame by frame: resampled to one length, or warped."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.distance import cdist

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .complete_postures import CompletePostures, learn_complete_postures, resampled

BATCH = 32
"""Clips of about the same length that are warped at once."""


@dataclass(frozen=True)
class Resampled:
    """Euclidean distance of clips that are all brought to the same number of frames."""

    n_frames: int = 30
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "ResampledLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        rows = np.stack([resampled(frames, self.n_frames).ravel() for frames in found])
        return ResampledLibrary(complete, rows, self.n_frames)


@dataclass(frozen=True, eq=False)
class ResampledLibrary:
    complete: CompletePostures
    rows: Array
    n_frames: int

    def describe(self, tracks: Tracks) -> Array:
        return resampled(self.complete(tracks), self.n_frames).ravel()

    def distances(self, query: Array, allowed: Flags) -> Array:
        return np.asarray(cdist(query[None], self.rows)[0])


@dataclass(frozen=True)
class Warped:
    """Dynamic time warping of principal components; own, all clips of a length at once.

    As `solvers.motion.warp`, without path: divided by the frames of both instead of its steps.
    """

    n_components: int | None = 12
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "WarpedLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        axes = np.linalg.eigh(complete.covariance)[1][:, ::-1][:, : self.n_components]
        short = [(frames - complete.mean) @ axes for frames in found]
        order = np.argsort([len(frames) for frames in short], kind="stable")
        batches = [order[start : start + BATCH] for start in range(0, len(order), BATCH)]
        padded = [_padded([short[index] for index in batch]) for batch in batches]
        lengths = np.array([len(frames) for frames in short])
        return WarpedLibrary(complete, axes, batches, padded, lengths)


@dataclass(frozen=True, eq=False)
class WarpedLibrary:
    complete: CompletePostures
    axes: Array
    batches: list[NDArray[np.intp]]
    padded: list[Array]
    lengths: NDArray[np.intp]

    def describe(self, tracks: Tracks) -> Array:
        return np.asarray((self.complete(tracks) - self.complete.mean) @ self.axes)

    def distances(self, query: Array, allowed: Flags) -> Array:
        result = np.empty(len(self.lengths))
        for batch, padded in zip(self.batches, self.padded, strict=True):
            result[batch] = warped_totals(query, padded, self.lengths[batch])
        return np.asarray(result / (self.lengths + len(query)))


def warped_totals(query: Array, padded: Array, lengths: NDArray[np.intp]) -> Array:
    """Return the least total distance along a path to each clip.

    Parameters
    ----------
    query : shape (n, n_features)
    padded : shape (n_clips, longest, n_features)
    lengths : shape (n_clips,)
    """
    n_clips, longest, n_features = padded.shape
    n = len(query)
    costs = cdist(query, padded.reshape(-1, n_features)).reshape(n, n_clips, longest)
    # Row k of `skewed` is the anti-diagonal i + j = k, at i; outside it is infinite.
    skewed = np.full((n + longest - 1, n, n_clips), np.inf)
    for i in range(n):
        skewed[i : i + longest, i] = costs[i].T
    before, last = np.full((2, n + 1, n_clips), np.inf)
    before[0] = 0.0
    totals = np.empty(n_clips)
    for k, row in enumerate(skewed):
        now = np.full((n + 1, n_clips), np.inf)
        now[1:] = row + np.minimum(np.minimum(last[1:], last[:-1]), before[:-1])
        ended = lengths - 1 + n - 1 == k
        totals[ended] = now[n, ended]
        before, last = last, now
    return totals


def _padded(found: list[Array]) -> Array:
    longest = max(map(len, found))
    return np.stack([
        np.pad(each, ((0, longest - len(each)), (0, 0)), "edge") for each in found
    ])
