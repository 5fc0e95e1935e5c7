"""How joints lie to each other in general, to fill in those that are not tracked."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion.posture_joints import N_JOINTS
from .clip_postures import ClipPostures

Array = NDArray[np.float64]

N_COORDINATES = 3 * N_JOINTS
NOISE = 0.01
"""Metres by which a joint may be beside what the covariance says of it."""
BRIDGED = 0.3
"""Seconds of a gap that a straight line bridges."""


@dataclass(frozen=True, eq=False)
class UsualPostures:
    """A normal distribution of postures.

    Attributes
    ----------
    mean, covariance : shapes (60,) and (60, 60), metres
    """

    mean: Array
    covariance: Array

    def filled(self, postures: ClipPostures) -> Array:
        """Return positions without gaps, shape (n_frames, 20, 3).

        Short gaps are bridged; elsewhere joints are where those that are seen let expect them.
        """
        flat = postures.positions.reshape(postures.n_frames, -1).copy()
        if np.isfinite(flat).all():
            return postures.positions
        _bridge(flat, round(BRIDGED * postures.frame_rate))
        patterns, of = np.unique(np.isfinite(flat), axis=0, return_inverse=True)
        for number, seen in enumerate(patterns):
            rows = np.flatnonzero(of.reshape(-1) == number)
            lost = ~seen
            among = self.covariance[np.ix_(seen, seen)] + NOISE**2 * np.eye(seen.sum())
            gain = np.linalg.solve(among, self.covariance[np.ix_(seen, lost)])
            beside = flat[np.ix_(rows, seen)] - self.mean[seen]
            flat[np.ix_(rows, lost)] = self.mean[lost] + beside @ gain
        return np.asarray(flat.reshape(postures.positions.shape))


def usual_postures(clips: Sequence[ClipPostures]) -> UsualPostures:
    """Learn from clips with gaps; what was never tracked lies at the hips."""
    flat = np.concatenate([clip.positions.reshape(clip.n_frames, -1) for clip in clips])
    seen = np.isfinite(flat)
    mean = np.where(seen, flat, 0.0).sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
    beside = np.where(seen, flat - mean, 0.0)
    together = seen.astype(np.float64).T @ seen
    sizes, axes = np.linalg.eigh(beside.T @ beside / np.maximum(together, 1.0))
    return UsualPostures(mean, np.asarray((axes * np.maximum(sizes, 0.0)) @ axes.T))


def _bridge(columns: Array, longest: int) -> None:
    """Draw straight lines over gaps of up to `longest` frames, in place."""
    frames = np.arange(len(columns))
    for column in columns.T:
        seen = np.flatnonzero(np.isfinite(column))
        if 0 < len(seen) < len(column):
            after = np.searchsorted(seen, frames)
            inside = (after > 0) & (after < len(seen))
            width = np.full(len(column), longest + 2)
            width[inside] = seen[after[inside]] - seen[after[inside] - 1]
            short = ~np.isfinite(column) & (width <= longest + 1)
            column[short] = np.interp(frames[short], seen, column[seen])
