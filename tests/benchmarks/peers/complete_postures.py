"""Complete postures for all peers of retrieval, however many joints of a query are missing.

Methods from the literature do not handle missing joints. So that they can be compared there
too, gaps are bridged in time and joints that were never observed get their most likely
positions, given the others (the conditional mean of a Gaussian of the library's postures).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.arrays import Array
from solvers.motion import Tracks
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.published.observed_signals import observed_signals

RIDGE_M2 = 1e-4
"""Meters squared; a standard deviation of one centimeter on each coordinate."""


@dataclass(frozen=True, eq=False)
class CompletePostures:
    """Fill missing joints of postures; frames are vectors of 60."""

    mean: Array
    covariance: Array
    frame_rate: float

    def __call__(self, tracks: Tracks) -> Array:
        return self.completed(clip_postures(tracks, self.frame_rate))

    def completed(self, postures: ClipPostures) -> Array:
        """Return frames, shape (n_frames, 60), without NaN."""
        signals, is_observed = observed_signals(postures.positions)
        if is_observed.all():
            return signals
        observed_covariance = self.covariance[
            np.ix_(is_observed, is_observed)
        ] + RIDGE_M2 * np.eye(is_observed.sum())
        weights = np.linalg.solve(
            observed_covariance, self.covariance[np.ix_(is_observed, ~is_observed)]
        )
        signals[:, ~is_observed] = (
            self.mean[~is_observed]
            + (signals[:, is_observed] - self.mean[is_observed]) @ weights
        )
        return signals


def learn_complete_postures(
    clips: Sequence[Tracks], frame_rate: float
) -> tuple[CompletePostures, list[Array]]:
    """Return what completes, and the library's clips as frames."""
    found = [observed_signals(clip_postures(clip, frame_rate).positions)[0] for clip in clips]
    frames = np.concatenate(found)
    complete = CompletePostures(frames.mean(axis=0), np.cov(frames.T), frame_rate)
    return complete, found


def resampled(frames: Array, n_frames: int) -> Array:
    """Return a clip at evenly spaced moments from its first frame to its last."""
    times = np.linspace(0.0, len(frames) - 1.0, n_frames)
    before = np.minimum(times.astype(int), max(len(frames) - 2, 0))
    after = np.minimum(before + 1, len(frames) - 1)
    part = (times - before)[:, None]
    return np.asarray((1.0 - part) * frames[before] + part * frames[after])
