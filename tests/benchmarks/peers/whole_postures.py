"""What all peers of retrieval see: whole postures, however much of a query is lost.

Methods from the literature know nothing of lost joints. So that they can be compared there too,
gaps are bridged in time and joints that were never seen are put where they most likely are,
given the others (the conditional mean of a Gaussian of the library's postures).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array
from solvers.motion import Tracks
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.published.observed_signals import observed_signals

RIDGE = 1e-4
"""Metres squared; a centimetre of doubt on each coordinate."""


@dataclass(frozen=True, eq=False)
class WholePostures:
    """OutputKind postures whole; frames are vectors of 60."""

    mean: Array
    covariance: Array
    frame_rate: float

    def __call__(self, tracks: Tracks) -> Array:
        return self.completed(clip_postures(tracks, self.frame_rate))

    def completed(self, postures: ClipPostures) -> Array:
        """Return frames, shape (n_frames, 60), without NaN."""
        signals, seen = observed_signals(postures.positions)
        if seen.all():
            return signals
        known = self.covariance[np.ix_(seen, seen)] + RIDGE * np.eye(seen.sum())
        to_lost = np.linalg.solve(known, self.covariance[np.ix_(seen, ~seen)])
        signals[:, ~seen] = self.mean[~seen] + (signals[:, seen] - self.mean[seen]) @ to_lost
        return signals


def learn_whole(
    clips: Sequence[Tracks], frame_rate: float
) -> tuple[WholePostures, list[Array]]:
    """Return what completes, and the library's clips as frames."""
    found = [observed_signals(clip_postures(clip, frame_rate).positions)[0] for clip in clips]
    frames = np.concatenate(found)
    whole = WholePostures(frames.mean(axis=0), np.cov(frames.T), frame_rate)
    return whole, found


def resampled(frames: Array, n_frames: int) -> Array:
    """Return a clip at evenly spaced moments from its first frame to its last."""
    moments = np.linspace(0.0, len(frames) - 1.0, n_frames)
    before = np.minimum(moments.astype(int), max(len(frames) - 2, 0))
    after = np.minimum(before + 1, len(frames) - 1)
    part = (moments - before)[:, None]
    return np.asarray((1.0 - part) * frames[before] + part * frames[after])
