"""Learn the Gaussian process of movements from simultaneous takes of a better system."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array, Integers, Single
from ...motion.humanoid import MIRROR_JOINTS, mirror_postures
from .movement_process import (
    PERSONAL_STRENGTHS,
    SHARED_STRENGTHS,
    MovementProcess,
    movement_covariance,
    movement_distances,
    movement_parts,
    project_parts,
)

N_COMPONENTS = 40
TAKE_VARIANCE, ACTOR_VARIANCE, MEAN_VARIANCE = 0.2, 1.9, 70.0
"""Variances of the constant errors of a take, an actor, and all, relative to the noise. Chosen
by hand; used in training only, so that no sweep varies it."""
MIN_KNOWN_FRACTION = 0.5
"""Minimum fraction of examples with a known joint for its prediction. Chosen by hand; used in
training only, so that no sweep varies it."""
MIN_EXAMPLES = 20
"""Minimum number of examples for a movement process."""


@dataclass(frozen=True, eq=False)
class TrainingTake:
    """One take: smoothed poses of mean size without gaps, and true minus observed positions.

    Both have shape (n_frames, 20, 3) and no heading; errors are NaN where unknown.
    """

    features: Array
    errors: Array
    frame_rate: float
    actor: str


def learn_movement_process(
    takes: Sequence[TrainingTake], frame_rate: float, n_points: int, mirror: bool
) -> MovementProcess | None:
    """Return the movement process, or None with too few examples.

    At most `n_points` examples are used, evenly distributed over all takes sampled at
    `frame_rate`. With `mirror`, each example also counts as its mirror image by another actor.
    The covariance is then [[A, B], [B, A]]; symmetric and antisymmetric errors are solved for
    with A + B and A - B.
    """
    parts, errors, take, actor = _gather_examples(takes, frame_rate)
    joints = _predictable_joints(errors, mirror)
    known = np.isfinite(errors[:, joints]).all(axis=(1, 2))
    rows = np.flatnonzero(known)
    if len(joints) < 2 or len(rows) < MIN_EXAMPLES:
        return None
    rows = rows[np.linspace(0, len(rows) - 1, min(n_points, len(rows))).round().astype(int)]
    parts, errors = parts[:, rows], np.nan_to_num(errors[rows])
    mirror_images = mirror_postures(parts) if mirror else parts
    center, axes = _principal_axes(np.concatenate([parts[0], mirror_images[0]])[:, joints])
    points, mirrored_points = (
        project_parts(one, joints, center, axes) for one in (parts, mirror_images)
    )
    covariance = _covariance(points, take[rows], actor[rows])
    if mirror:
        mirror_covariance = (
            movement_covariance(
                movement_distances(points, mirrored_points), SHARED_STRENGTHS
            ).astype(np.float64)
            + MEAN_VARIANCE
        )
        symmetric = 0.5 * (errors + mirror_postures(errors))
        weights = _solve(covariance + mirror_covariance, symmetric) + _solve(
            covariance - mirror_covariance, errors - symmetric
        )
        weight_sum = weights.sum(axis=0)
        mean = MEAN_VARIANCE * (weight_sum + mirror_postures(weight_sum))
    else:
        weights = _solve(covariance, errors)
        mean = MEAN_VARIANCE * weights.sum(axis=0)
    flat = weights[:, joints].reshape(len(rows), -1)
    return MovementProcess(
        joints, center, axes, points, flat.astype(np.float32), mean[joints].reshape(-1),
        np.array(mirror),
    )  # fmt: skip


def _gather_examples(
    takes: Sequence[TrainingTake], frame_rate: float
) -> tuple[Array, Array, Integers, Integers]:
    """Return parts and errors of sampled frames, with their take and actor indices."""
    names = sorted({one.actor for one in takes})
    parts, errors, take, actor = [], [], [], []
    for number, one in enumerate(takes):
        step = max(round(one.frame_rate / frame_rate), 1)
        selection = slice(min(step // 2, len(one.features) - 1), None, step)
        parts.append(movement_parts(one.features, one.frame_rate)[:, selection])
        errors.append(one.errors[selection])
        take += [number] * len(errors[-1])
        actor += [names.index(one.actor)] * len(errors[-1])
    return (
        np.concatenate(parts, axis=1),
        np.concatenate(errors),
        np.array(take),
        np.array(actor),
    )


def _predictable_joints(errors: Array, mirror: bool) -> Integers:
    """Return the joints that are known often enough, as are their mirror images."""
    fraction = np.isfinite(errors).all(axis=-1).mean(axis=0)
    if mirror:
        fraction = np.minimum(fraction, fraction[list(MIRROR_JOINTS)])
    return np.flatnonzero(fraction >= MIN_KNOWN_FRACTION).astype(np.int64)


def _principal_axes(postures: Array) -> tuple[Array, Array]:
    """Return mean and principal axes of poses."""
    flat = postures.reshape(len(postures), -1)
    center = flat.mean(axis=0)
    axes = np.linalg.svd(flat - center, full_matrices=False)[2][:N_COMPONENTS].T
    return center, np.ascontiguousarray(axes)


def _covariance(points: Single, take: Integers, actor: Integers) -> Array:
    distances = movement_distances(points, points)
    result = movement_covariance(distances, SHARED_STRENGTHS).astype(np.float64) + MEAN_VARIANCE
    same = actor[:, None] == actor
    result += same * (
        movement_covariance(distances, PERSONAL_STRENGTHS).astype(np.float64) + ACTOR_VARIANCE
    )
    result += TAKE_VARIANCE * (take[:, None] == take)
    result[np.diag_indices(len(points))] += 1.0
    return result


def _solve(covariance: Array, errors: Array) -> Array:
    factor = scipy.linalg.cho_factor(covariance, lower=True, check_finite=False)
    solution = scipy.linalg.cho_solve(
        factor, errors.reshape(len(errors), -1), check_finite=False
    )
    return np.asarray(solution.reshape(errors.shape))
