"""Gaussian process over a pose and the poses before and after it.

Errors depend on movement too: a falling hand is estimated too near the body, a knee lags
behind. All joints share one covariance, so one solution serves them all:

k = a1 k(pose) + a2 linear(pose) + a3 k(pose, before, after) + a4 k(movement)

Before and after are half a second away. Movement is the difference of the pose from the mean of
the surrounding seconds, and its velocity.
"""

from dataclasses import dataclass, fields
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array, Single, row_blocks
from ...motion.humanoid import N_JOINTS, mirror_postures
from ...npz_members import flags, integers, numbers
from ...signals import smooth_gaussian
from .kernel import squared_distances

CONTEXT_S = 0.5
"""Time (s) to the poses before and after. Half and twice gain less than 1 %
(`make sensitivity`)."""
MEAN_WINDOW_S = 1.0
"""Time (s) on both sides of the mean that a pose is compared with. Sweep: x0.1 gains 0.3 %; the
shipped prior was learned with it."""
SPEED_SMOOTHING_S = 0.1
"""Standard deviation (s) of the Gaussian that smooths velocities. Sweep: from x0.1 to x10 the
mean changes by 0.01 %; the shipped prior was learned with it."""
PACE_S = 0.2
"""Time (s) that converts velocity to distance. Sweep: x10 costs 0.3 %; the shipped prior was
learned with it."""
N_PARTS = 5


KEYS = {"center": "centre"}
"""Stored names that differ from the attributes: files keep them."""
MEMBERS = {
    "joints": integers("moving", minimum=0, maximum=N_JOINTS - 1, optional=True),
    "centre": numbers("3*moving", optional=True),
    "axes": numbers("3*moving", "axes", optional=True),
    "points": numbers("points", N_PARTS, "axes", optional=True),
    "weights": numbers("points", "3*moving", optional=True),
    "mean": numbers("3*moving", optional=True),
    "mirrored": flags(optional=True),
}
"""Arrays of a movement process in a file: all or none of them."""


class Strengths(NamedTuple):
    """Strengths of the covariance terms, relative to the noise variance."""

    posture: float
    slope: float
    """Per square meter."""
    context: float
    movement: float


SHARED_STRENGTHS = Strengths(9.3, 56.0, 3.5, 2.3)
"""Weights, relative to the noise, of what all actors share. Chosen by the sweep below."""
PERSONAL_STRENGTHS = Strengths(2.6, 3.6, 3.0, 0.47)
"""Weights of what one actor has alone. Chosen by the sweep below."""
POSTURE_SCALE_M, CONTEXT_SCALE_M, MOVEMENT_SCALE_M = 0.88, 1.63, 0.82
"""Length scales (m) of features. All these values were chosen by a sweep on UI-PRMD that leaves
out one of four actors; each choice without a fifth actor gives the same values."""


COVERAGE_RANGE_M = (1.0, 0.3)
"""Context distance (m) up to which movements count as covered, and the fall-off beyond. Of
actors outside the training set, 95 in 100 are covered; of exercises outside it, half are. Half
and twice gain less than 1 % (`make sensitivity`)."""


class MovementDistances(NamedTuple):
    """Squared distances between frames, square meters; dot products for `slope`."""

    posture: Single
    slope: Single
    context: Single
    movement: Single


@dataclass(frozen=True, eq=False)
class MovementProcess:
    """Learned process: errors correlate with those of similar points.

    Attributes
    ----------
    joints : shape (n,), int
        Which of the 20 joints are used and predicted.
    center : shape (3 n,), meters
        The mean pose, stored as "centre".
    axes : shape (3 n, n_components)
        Principal components of poses.
    points : float32, shape (n_points, 5, n_components)
        Examples as `project` gives them.
    weights : float32, shape (n_points, 3 n)
    mean : shape (3 n,), meters
    mirrored : shape (), bool
        Whether each point also represents its mirror image.
    """

    joints: NDArray[np.int64]
    center: Array
    axes: Array
    points: Single
    weights: Single
    mean: Array
    mirrored: NDArray[np.bool_]

    def arrays(self) -> dict[str, NDArray[np.generic]]:
        """Return the arrays to store in a file."""
        return {KEYS.get(one.name, one.name): getattr(self, one.name) for one in fields(self)}

    def predict(
        self, features: Array, frame_rate: float, frames: NDArray[np.intp]
    ) -> tuple[Array, Array]:
        """Predict true minus observed position in some frames, and their proximity to the
        points.

        Parameters
        ----------
        features : shape (n_frames, 20, 3), meters
            Smoothed poses of mean body size, without gaps.
        frame_rate : float, hertz
        frames : shape (n,), int

        Returns
        -------
        offsets : shape (n, 20, 3), meters; 0 for joints without prediction
        nearness : shape (n,), 0 to 1
        """
        parts = movement_parts(features, frame_rate)[:, frames]
        result = np.zeros((len(frames), N_JOINTS, 3))
        predicted, squares = self._predict_offsets(parts)
        result[:, self.joints] = self.mean.reshape(-1, 3) + predicted
        if self.mirrored:
            image = np.zeros_like(result)
            image[:, self.joints], mirrored_squares = self._predict_offsets(
                mirror_postures(parts)
            )
            result += mirror_postures(image)
            squares = np.minimum(squares, mirrored_squares)
        full_coverage, fall_off = COVERAGE_RANGE_M
        return result, np.exp(
            -0.5 * (np.maximum(np.sqrt(squares) - full_coverage, 0.0) / fall_off) ** 2
        )

    def _predict_offsets(self, parts: Array) -> tuple[Array, Array]:
        """Return predicted offsets, and the squared distance to the nearest point."""
        projected = self.project(parts)
        predicted, squares = (
            np.empty((len(projected), self.weights.shape[1])),
            np.empty(len(projected)),
        )
        for rows in row_blocks(len(projected), len(self.weights)):
            distances = movement_distances(projected[rows], self.points)
            predicted[rows] = movement_covariance(distances, SHARED_STRENGTHS) @ self.weights
            squares[rows] = distances.context.min(axis=1)
        return predicted.reshape(len(projected), -1, 3), squares

    def project(self, parts: Array) -> Single:
        """Return principal components of `movement_parts`, (n, 5, n_components)."""
        return project_parts(parts, self.joints, self.center, self.axes)


def movement_parts(features: Array, frame_rate: float) -> Array:
    """Return poses now, before, after, offsets from the mean, velocities; (5, n, 20, 3)."""
    n = len(features)
    away = max(round(CONTEXT_S * frame_rate), 1)
    window = 2 * round(MEAN_WINDOW_S * frame_rate) + 1
    frames = np.arange(n)
    counts = scipy.ndimage.uniform_filter1d(np.ones(n), window, mode="constant")[:, None, None]
    mean = scipy.ndimage.uniform_filter1d(features, window, axis=0, mode="constant") / counts
    smooth = smooth_gaussian(features, SPEED_SMOOTHING_S * frame_rate)
    speed = np.gradient(smooth, 1.0 / frame_rate, axis=0) if n > 1 else 0.0 * features
    before = features[np.maximum(frames - away, 0)]
    after = features[np.minimum(frames + away, n - 1)]
    return np.stack([features, before, after, features - mean, PACE_S * speed])


def project_parts(
    parts: Array, joints: NDArray[np.int64], center: Array, axes: Array
) -> Single:
    """Return principal components of the parts, (n, 5, n_components); poses are centered."""
    flat = parts[:, :, joints].reshape(*parts.shape[:2], -1)
    flat[:3] -= center
    return np.ascontiguousarray((flat @ axes).swapaxes(0, 1), dtype=np.float32)


def movement_distances(one: Single, other: Single) -> MovementDistances:
    """Return the distances between two sets of frames, each (n_one, n_other)."""

    def part_distances(first: int, last: int) -> Single:
        rows, columns = (
            np.ascontiguousarray(side[:, first:last]).reshape(len(side), -1)
            for side in (one, other)
        )
        return squared_distances(rows, columns)

    posture, context, movement = (
        part_distances(0, 1),
        part_distances(1, 3),
        part_distances(3, N_PARTS),
    )
    slope: Single = one[:, 0] @ other[:, 0].T
    return MovementDistances(posture, slope, posture + context, movement)


def movement_covariance(distances: MovementDistances, strengths: Strengths) -> Single:
    """Return the covariance of two sets of frames, (n_one, n_other), relative to the noise."""
    result = np.float32(strengths.slope) * distances.slope
    for square, strength, size in zip(
        (distances.posture, distances.context, distances.movement),
        (strengths.posture, strengths.context, strengths.movement),
        (POSTURE_SCALE_M, CONTEXT_SCALE_M, MOVEMENT_SCALE_M),
        strict=True,
    ):
        result += np.float32(strength) * np.exp(square * np.float32(-0.5 / size**2))
    return result


def movement_from_arrays(arrays: dict[str, NDArray[Any]]) -> tuple[str, MovementProcess | None]:
    """Return why arrays of a file, `MEMBERS`, cannot be used, or "", and the process."""
    if set(arrays) != set(MEMBERS):
        return "arrays of the movement process are missing", None
    joints = arrays["joints"].astype(np.int64)
    if not len(joints) or not arrays["axes"].size or not len(arrays["points"]):
        return "the movement process is empty", None
    center, axes, mean = (
        arrays[name].astype(np.float64) for name in ("centre", "axes", "mean")
    )
    points, weights = (arrays[name].astype(np.float32) for name in ("points", "weights"))
    is_mirrored = arrays["mirrored"].astype(np.bool_)
    return "", MovementProcess(joints, center, axes, points, weights, mean, is_mirrored)
