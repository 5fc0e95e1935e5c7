"""A Gaussian process that sees a posture, where it came from, and where it goes.

Errors depend on movement too: a hand that is drawn to the body on its way down, a knee that is
seen too late. All joints share one covariance, so one solution serves them all:

k = a1 k(posture) + a2 linear(posture) + a3 k(posture, before, after) + a4 k(movement)

where before and after are half a second away, and movement is how the posture differs from the
mean of the seconds around, and its speed.
"""

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, uniform_filter1d

from ...motion.humanoid import N_JOINTS, mirrored
from ...npz_members import flags, integers, numbers
from .kernel import squared_distances

Array = NDArray[np.float64]
Single = NDArray[np.float32]

CONTEXT_S = 0.5
"""Seconds to the postures before and after that are looked at."""
MEAN_WINDOW_S = 1.0
"""Seconds to both sides whose mean a posture is compared with."""
SPEED_SMOOTHING_S = 0.1
"""Seconds of the Gaussian that steadies speeds."""
PACE_S = 0.2
"""Seconds of movement that count as much as the same way between two postures."""
N_PARTS = 5
BLOCK = 512


MEMBERS = {
    "joints": integers("moving", minimum=0, maximum=N_JOINTS - 1, optional=True),
    "centre": numbers("3*moving", optional=True),
    "axes": numbers("3*moving", "axes", optional=True),
    "points": numbers("points", N_PARTS, "axes", optional=True),
    "weights": numbers("points", "3*moving", optional=True),
    "mean": numbers("3*moving", optional=True),
    "mirrored": flags(optional=True),
}
"""What a file keeps of a movement process: all, or nothing of it."""


class Strengths(NamedTuple):
    """What each part of the covariance counts, in variances of the noise."""

    posture: float
    slope: float
    """For each square metre."""
    context: float
    movement: float


SHARED_STRENGTHS = Strengths(9.3, 56.0, 3.5, 2.3)
PERSONAL_STRENGTHS = Strengths(2.6, 3.6, 3.0, 0.47)
POSTURE_SCALE_M, CONTEXT_SCALE_M, MOVEMENT_SCALE_M = 0.88, 1.63, 0.82
"""Metres of features that may differ. All these numbers were chosen on UI-PRMD by leaving out
one of four actors; to choose for each fifth actor without him gives the same."""


COVERAGE_RANGE_M = (1.0, 0.3)
"""Metres of posture, before and after up to which movements count as known, and how fast they
become unknown beyond. Of actors who were left out 95 in 100 lie within, of exercises that were
left out half."""


class MovementDistances(NamedTuple):
    """Squared distances of each frame to each other one, square metres; products for slope."""

    posture: Single
    slope: Single
    context: Single
    movement: Single


@dataclass(frozen=True, eq=False)
class MovementProcess:
    """What was learned: a posture's errors are like those of the points that it is like.

    Attributes
    ----------
    joints : shape (n,), int
        Which of the 20 joints are looked at and foretold.
    centre : shape (3 n,), metres
        The mean posture.
    axes : shape (3 n, n_components)
        Principal components of postures.
    points : float32, shape (n_points, 5, n_components)
        Examples as `seen_from` gives them.
    weights : float32, shape (n_points, 3 n)
    mean : shape (3 n,), metres
    mirrored : shape (), bool
        Whether each point stands for its mirror image too.
    """

    joints: NDArray[np.int64]
    centre: Array
    axes: Array
    points: Single
    weights: Single
    mean: Array
    mirrored: NDArray[np.bool_]

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """Return what is kept in a file."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    def foretell(
        self, features: Array, frame_rate: float, frames: NDArray[np.intp]
    ) -> tuple[Array, Array]:
        """Return true minus seen place in some frames, and how near they are to the points.

        Parameters
        ----------
        features : shape (n_frames, 20, 3), metres
            Calm postures of usual size, without gaps.
        frame_rate : float, hertz
        frames : shape (n,), int

        Returns
        -------
        offsets : shape (n, 20, 3), metres; 0 for joints that are not foretold
        nearness : shape (n,), 0 to 1
        """
        parts = movement_parts(features, frame_rate)[:, frames]
        result = np.zeros((len(frames), N_JOINTS, 3))
        told, away = self._told(parts)
        result[:, self.joints] = self.mean.reshape(-1, 3) + told
        if self.mirrored:
            image = np.zeros_like(result)
            image[:, self.joints], also = self._told(mirrored(parts))
            result += mirrored(image)
            away = np.minimum(away, also)
        near, fall = COVERAGE_RANGE_M
        return result, np.exp(-0.5 * (np.maximum(np.sqrt(away) - near, 0.0) / fall) ** 2)

    def _told(self, parts: Array) -> tuple[Array, Array]:
        """Return the weighted likeness to all points, and the squared way to the nearest."""
        seen = self.seen_from(parts)
        told, away = np.empty((len(seen), self.weights.shape[1])), np.empty(len(seen))
        for start in range(0, len(seen), BLOCK):
            rows = slice(start, start + BLOCK)
            ways = movement_distances(seen[rows], self.points)
            told[rows] = movement_covariance(ways, SHARED_STRENGTHS) @ self.weights
            away[rows] = ways.context.min(axis=1)
        return told.reshape(len(seen), -1, 3), away

    def seen_from(self, parts: Array) -> Single:
        """Return principal components of `movement_parts`, (n, 5, n_components)."""
        return project_parts(parts, self.joints, self.centre, self.axes)


def movement_parts(features: Array, frame_rate: float) -> Array:
    """Return postures now, before and after, how they differ, and speeds, (5, n, 20, 3)."""
    n = len(features)
    away = max(round(CONTEXT_S * frame_rate), 1)
    window = 2 * round(MEAN_WINDOW_S * frame_rate) + 1
    frames = np.arange(n)
    counts = uniform_filter1d(np.ones(n), window, mode="constant")[:, None, None]
    mean = uniform_filter1d(features, window, axis=0, mode="constant") / counts
    steady = gaussian_filter1d(features, SPEED_SMOOTHING_S * frame_rate, axis=0, mode="nearest")
    speed = np.gradient(steady, 1.0 / frame_rate, axis=0) if n > 1 else 0.0 * features
    before = features[np.maximum(frames - away, 0)]
    after = features[np.minimum(frames + away, n - 1)]
    return np.stack([features, before, after, features - mean, PACE_S * speed])


def project_parts(
    parts: Array, joints: NDArray[np.int64], centre: Array, axes: Array
) -> Single:
    """Return principal components of the parts, (n, 5, n_components); postures are centred."""
    flat = parts[:, :, joints].reshape(*parts.shape[:2], -1)
    flat[:3] -= centre
    return np.ascontiguousarray((flat @ axes).swapaxes(0, 1), dtype=np.float32)


def movement_distances(one: Single, other: Single) -> MovementDistances:
    """Return how far two lots of frames are from each other, each (n_one, n_other)."""

    def parted(first: int, last: int) -> Single:
        rows, columns = (
            np.ascontiguousarray(side[:, first:last]).reshape(len(side), -1)
            for side in (one, other)
        )
        return squared_distances(rows, columns)

    posture, beside, moved = parted(0, 1), parted(1, 3), parted(3, N_PARTS)
    slope: Single = one[:, 0] @ other[:, 0].T
    return MovementDistances(posture, slope, posture + beside, moved)


def movement_covariance(ways: MovementDistances, strengths: Strengths) -> Single:
    """Return the covariance of two lots of frames, (n_one, n_other), in variances of noise."""
    result = np.float32(strengths.slope) * ways.slope
    for way, strength, size in zip(
        (ways.posture, ways.context, ways.movement),
        (strengths.posture, strengths.context, strengths.movement),
        (POSTURE_SCALE_M, CONTEXT_SCALE_M, MOVEMENT_SCALE_M),
        strict=True,
    ):
        result += np.float32(strength) * np.exp(way * np.float32(-0.5 / size**2))
    return result


def movement_from_arrays(arrays: dict[str, NDArray[Any]]) -> tuple[str, MovementProcess | None]:
    """Return what keeps `MEMBERS` from a file from being used, or nothing, and the process."""
    if set(arrays) != set(MEMBERS):
        return "parts of the movements are missing", None
    joints = arrays["joints"].astype(np.int64)
    if not len(joints) or not arrays["axes"].size or not len(arrays["points"]):
        return "the movements hold nothing", None
    centre, axes, mean = (
        arrays[name].astype(np.float64) for name in ("centre", "axes", "mean")
    )
    points, weights = (arrays[name].astype(np.float32) for name in ("points", "weights"))
    alike = arrays["mirrored"].astype(np.bool_)
    return "", MovementProcess(joints, centre, axes, points, weights, mean, alike)
