"""How joints lie to each other in general, to fill in those that are not tracked."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...motion.humanoid import ACROSS, N_JOINTS, PARENTS, USUAL_LENGTHS, segment_lengths, turned
from .clip_postures import ClipPostures

Array = NDArray[np.float64]

N_COORDINATES = 3 * N_JOINTS
POSITION_NOISE_M = 0.03
"""Metres by which a joint may be beside what the covariance says of it."""
MAX_LENGTH_RATIO = 1.4
"""Times by which a way past lost joints is made longer or shorter at most."""
MIN_PATH_M = 0.01
"""Metres of such a way."""
MIN_OBSERVED_FRACTION = 0.9
"""Share of the frames in which a joint is seen that tells the heading of a clip."""
MIN_HEADING_JOINTS = 3
"""Such joints, of those that lack none a heading can be told."""
N_HEADING_FRAMES = 24
"""Frames that are looked at for it."""
NEAR_ANGLES = np.radians(np.arange(-75.0, 76.0, 5.0))
ALL_ANGLES = np.radians(np.arange(-180.0, 180.0, 5.0))
"""Angles that are tried for a heading that is roughly known, and for one that is not."""
HEADING_ERROR_RAD = np.radians(20.0)
"""Standard deviation of the angle by which a body without some joints is turned wrongly."""
HEADING_NOISE_M = 0.03
"""Metres by which a joint may be beside what the covariance says, for the heading."""


@dataclass(frozen=True, eq=False)
class PostureDistribution:
    """A normal distribution of postures.

    Attributes
    ----------
    mean, covariance : shapes (60,) and (60, 60), metres
    """

    mean: Array
    covariance: Array

    def completed(self, postures: ClipPostures) -> ClipPostures:
        """Return postures without gaps.

        Joints are where those that are seen let expect them. Before, a body that lacks joints
        is turned to where it is most usual: its hips and shoulders told badly which way it
        faces.
        """
        if np.isfinite(postures.positions).all():
            return postures
        turned_right = self._turned_right(postures)
        return replace(turned_right, positions=self.filled(turned_right))

    def filled(self, postures: ClipPostures) -> Array:
        """Return positions without gaps, shape (n_frames, 20, 3); the heading stays.

        What hangs on a joint that is lost lies where it was seen, in an actor of other
        proportions: once that joint is roughly known, the way past it gets its usual length,
        and it is told anew.
        """
        seen = np.isfinite(postures.positions)
        if seen.all():
            return postures.positions
        rough = self._expected(postures.positions)
        return self._expected(_correct_proportions(rough, seen.all(axis=-1)))

    def _expected(self, positions: Array) -> Array:
        """Put joints that are not seen where those that are let expect them."""
        flat = positions.reshape(len(positions), -1).copy()
        patterns, of = np.unique(np.isfinite(flat), axis=0, return_inverse=True)
        for number, seen in enumerate(patterns):
            rows = np.flatnonzero(of.reshape(-1) == number)
            lost = ~seen
            among = self.covariance[np.ix_(seen, seen)] + POSITION_NOISE_M**2 * np.eye(
                seen.sum()
            )
            gain = np.linalg.solve(among, self.covariance[np.ix_(seen, lost)])
            beside = flat[np.ix_(rows, seen)] - self.mean[seen]
            flat[np.ix_(rows, lost)] = self.mean[lost] + beside @ gain
        return np.asarray(flat.reshape(positions.shape))

    def _turned_right(self, postures: ClipPostures) -> ClipPostures:
        """Turn a clip by the one angle that makes what was seen of it most probable."""
        often = (
            np.isfinite(postures.positions).all(axis=-1).mean(axis=0) > MIN_OBSERVED_FRACTION
        )
        if often.all() or often.sum() < MIN_HEADING_JOINTS:
            return postures
        seen = postures.positions[:, often]
        whole = seen[np.isfinite(seen).all(axis=(1, 2))]
        some = whole[
            np.linspace(0, len(whole) - 1, min(N_HEADING_FRAMES, len(whole))).astype(int)
        ]
        columns = np.repeat(often, 3)
        among = self.covariance[np.ix_(columns, columns)] + HEADING_NOISE_M**2 * np.eye(
            columns.sum()
        )
        way = np.linalg.inv(np.linalg.cholesky(among)).T
        angles, unlikely = NEAR_ANGLES, 0.5 * (NEAR_ANGLES / HEADING_ERROR_RAD) ** 2
        if not _observes_heading(postures):
            angles, unlikely = ALL_ANGLES, np.zeros(len(ALL_ANGLES))
        tried = [turned(some, np.full(len(some), angle)) for angle in angles]
        beside = np.reshape(tried, (len(angles), len(some), -1)) - self.mean[columns]
        costs = 0.5 * ((beside @ way) ** 2).sum(axis=-1).mean(axis=-1)
        angle = _parabola_minimum(angles, costs + unlikely)
        return ClipPostures(
            turned(postures.positions, np.full(postures.n_frames, angle)),
            _rotate_velocity(postures.course, angle),
            postures.frame_rate,
        )


def _observes_heading(postures: ClipPostures) -> bool:
    """Tell whether hips or shoulders showed, at any time, which way the body faces."""
    seen = np.isfinite(postures.positions).all(axis=-1)
    return any((seen[:, list(joints)].sum(axis=1) >= 2).any() for joints in ACROSS)


def _correct_proportions(positions: Array, seen: NDArray[np.bool_]) -> Array:
    """Give the ways past lost joints their usual lengths; lost joints become NaN.

    Parameters
    ----------
    positions : shape (n_frames, 20, 3), metres
        Those of lost joints are rough.
    seen : shape (n_frames, 20)
    """
    lengths = segment_lengths(positions)
    # Of the last seen joint on the way to each: where it was and now is, and the way since.
    was, now = positions.copy(), positions.copy()
    way, usual = np.zeros(seen.shape), np.zeros(seen.shape)
    for joint in range(1, N_JOINTS):
        above = PARENTS[joint]
        since = way[:, above] + lengths[:, joint], usual[:, above] + USUAL_LENGTHS[joint]
        scale = np.clip(
            since[1] / np.maximum(since[0], MIN_PATH_M),
            1.0 / MAX_LENGTH_RATIO,
            MAX_LENGTH_RATIO,
        )
        place = now[:, above] + scale[:, None] * (positions[:, joint] - was[:, above])
        here = seen[:, joint]
        was[:, joint] = np.where(here[:, None], positions[:, joint], was[:, above])
        now[:, joint] = np.where(here[:, None], place, now[:, above])
        way[:, joint], usual[:, joint] = np.where(here, 0.0, since)
    return np.where(seen[..., None], now, np.nan)


def _parabola_minimum(places: Array, values: Array) -> float:
    """Return where the parabola through the least of evenly spaced values is lowest."""
    best = int(values.argmin())
    if not 0 < best < len(values) - 1:
        return float(places[best])
    before, here, after = values[best - 1 : best + 2]
    bend = max(before - 2.0 * here + after, 1e-9)
    return float(places[best] + 0.5 * (places[1] - places[0]) * (before - after) / bend)


def _rotate_velocity(course: Array, angle: float) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    left, back, *others = course.T
    return np.stack([cos * left - sin * back, sin * left + cos * back, *others], axis=-1)


def learn_posture_distribution(clips: Sequence[ClipPostures]) -> PostureDistribution:
    """Learn from clips with gaps; what was never tracked lies at the hips."""
    flat = np.concatenate([clip.positions.reshape(clip.n_frames, -1) for clip in clips])
    seen = np.isfinite(flat)
    mean = np.where(seen, flat, 0.0).sum(axis=0) / np.maximum(seen.sum(axis=0), 1)
    beside = np.where(seen, flat - mean, 0.0)
    together = seen.astype(np.float64).T @ seen
    sizes, axes = np.linalg.eigh(beside.T @ beside / np.maximum(together, 1.0))
    return PostureDistribution(mean, np.asarray((axes * np.maximum(sizes, 0.0)) @ axes.T))


def is_covariance(matrix: Array) -> bool:
    """Whether a matrix may be that of `learn_posture_distribution`; others have no solution."""
    return bool(
        np.allclose(matrix, matrix.T)
        and np.linalg.eigvalsh(matrix)[0] > -0.5 * POSITION_NOISE_M**2
    )
