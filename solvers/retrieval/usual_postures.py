"""How joints lie to each other in general, to fill in those that are not tracked."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..motion.posture_heading import turned
from ..motion.posture_joints import N_JOINTS
from .clip_postures import ClipPostures

Array = NDArray[np.float64]

N_COORDINATES = 3 * N_JOINTS
NOISE = 0.03
"""Metres by which a joint may be beside what the covariance says of it."""
BRIDGED = 0.3
"""Seconds of a gap that a straight line bridges."""
OFTEN = 0.9
"""Share of the frames in which a joint is seen that tells the heading of a clip."""
FEWEST = 3
"""Such joints, of those that lack none a heading can be told."""
LOOKS = 24
"""Frames that are looked at for it."""
ANGLES = np.radians(np.arange(-75.0, 76.0, 5.0))
TURNED = np.radians(20.0)
"""Standard deviation of the angle by which a body without some joints is turned wrongly."""
UNUSUAL = 0.03
"""Metres by which a joint may be beside what the covariance says, for the heading."""


@dataclass(frozen=True, eq=False)
class UsualPostures:
    """A normal distribution of postures.

    Attributes
    ----------
    mean, covariance : shapes (60,) and (60, 60), metres
    """

    mean: Array
    covariance: Array

    def completed(self, postures: ClipPostures) -> ClipPostures:
        """Return postures without gaps.

        Short gaps are bridged; elsewhere joints are where those that are seen let expect them.
        Before, a body that lacks joints is turned to where it is most usual: its hips and
        shoulders told badly which way it faces.
        """
        if np.isfinite(postures.positions).all():
            return postures
        turned_right = self._turned_right(postures)
        return replace(turned_right, positions=self.filled(turned_right))

    def filled(self, postures: ClipPostures) -> Array:
        """Return positions without gaps, shape (n_frames, 20, 3); the heading stays."""
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

    def _turned_right(self, postures: ClipPostures) -> ClipPostures:
        """Turn a clip by the one angle that makes what was seen of it most probable."""
        often = np.isfinite(postures.positions).all(axis=-1).mean(axis=0) > OFTEN
        if often.all() or often.sum() < FEWEST:
            return postures
        seen = postures.positions[:, often]
        whole = seen[np.isfinite(seen).all(axis=(1, 2))]
        some = whole[np.linspace(0, len(whole) - 1, min(LOOKS, len(whole))).astype(int)]
        columns = np.repeat(often, 3)
        among = self.covariance[np.ix_(columns, columns)] + UNUSUAL**2 * np.eye(columns.sum())
        way = np.linalg.inv(np.linalg.cholesky(among)).T
        tried = [turned(some, np.full(len(some), angle)) for angle in ANGLES]
        beside = np.reshape(tried, (len(ANGLES), len(some), -1)) - self.mean[columns]
        costs = 0.5 * ((beside @ way) ** 2).sum(axis=-1).mean(axis=-1)
        angle = _lowest(ANGLES, costs + 0.5 * (ANGLES / TURNED) ** 2)
        return ClipPostures(
            turned(postures.positions, np.full(postures.n_frames, angle)),
            _turned_course(postures.course, angle),
            postures.frame_rate,
        )


def _lowest(places: Array, values: Array) -> float:
    """Return where the parabola through the least of evenly spaced values is lowest."""
    best = int(values.argmin())
    if not 0 < best < len(values) - 1:
        return float(places[best])
    before, here, after = values[best - 1 : best + 2]
    bend = max(before - 2.0 * here + after, 1e-9)
    return float(places[best] + 0.5 * (places[1] - places[0]) * (before - after) / bend)


def _turned_course(course: Array, angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    left, back, *others = course.T
    return np.stack([cos * left - sin * back, sin * left + cos * back, *others], axis=-1)


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
