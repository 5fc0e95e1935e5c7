"""Fit poses of a body to observed markers."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..progress import Progress, unwatched
from ..rotations import (
    quaternion_from_matrix,
    rotation_vector_from_quaternion,
    skew_matrices,
)
from .body import MarkerBody, Poses, WorldBody
from .vectors import matrix_from_rotation_vector

FRAMES_PER_BLOCK = 256
"""Frames that are fitted at once. It bounds the memory."""
CAUCHY_SCALE = 3.0
"""Scale of the Cauchy weight, in standard deviations of a marker's noise. Three-sigma rule:
farther markers have less than half of their weight."""
DAMPING = 1e-3
"""Initial weight of Levenberg-Marquardt damping, relative to the diagonal: that of Madsen,
Nielsen, Tingleff (2004), Methods for non-linear least squares problems, eq. 3.14."""
DAMPING_RISE, DAMPING_FALL = 8.0, 5.0
"""Factors by which the damping rises after a step that raised the cost, and falls after one
that lowered it, here and in the fit of the body. Chosen by hand; `make sensitivity` varies
them."""
MAX_STEP_RAD = 0.5
"""Radians: maximum rotation of a joint in one step. Chosen by hand; `make sensitivity` varies
it."""
MIN_COST_GAIN = 1e-4
"""Relative gain of the cost below which the iteration ends. It bounds the run time."""


class Residuals(NamedTuple):
    """Normalized residuals, and their derivatives by the pose."""

    residuals: Array
    """Shape (n_frames, n_residuals)."""
    slopes: Array
    """Derivatives by the pose, shape (n_frames, n_residuals, n_unknowns)."""
    weights: Array
    """Weights of the markers, per meter, shape (n_frames, n_markers, 1)."""
    world: WorldBody


def fit_poses(
    body: MarkerBody,
    observed: Array,
    poses: Poses,
    *,
    most_steps: int = 12,
    progress: Progress = unwatched,
) -> Poses:
    """Fit joint rotations to markers: global optimization [1]_ by Levenberg-Marquardt.

    Frames are independent and solved in blocks. Cauchy weights limit the influence of markers
    with large residuals.

    Parameters
    ----------
    body : MarkerBody
    observed : shape (n_frames, n_markers, 3), meters
        In the order of the body's markers; NaN: missing.
    poses : Poses
        Initial poses.
    most_steps : int
    progress : Progress

    References
    ----------
    .. [1] Lu, O'Connor (1999). Bone position estimation from skin marker co-ordinates using
       global optimization with joint constraints. J Biomech 32(2).
       doi:10.1016/S0021-9290(98)00158-4
    """
    parts = []
    for start in range(0, len(observed), FRAMES_PER_BLOCK):
        block = slice(start, start + FRAMES_PER_BLOCK)
        initial = Poses(poses.rotations[block], poses.roots[block])
        parts.append(_fit(body, observed[block], initial, most_steps))
        progress(min(1.0, (start + FRAMES_PER_BLOCK) / len(observed)), "Fitting poses")
    return Poses(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _fit(body: MarkerBody, observed: Array, poses: Poses, most_steps: int) -> Poses:
    damping = np.full(len(observed), DAMPING)
    cost = cost_of(body, observed, poses)
    for _ in range(most_steps):
        residuals_of_pose = compute_residuals(body, observed, poses)
        normal = np.swapaxes(residuals_of_pose.slopes, 1, 2) @ residuals_of_pose.slopes
        slope = np.einsum("fru,fr->fu", residuals_of_pose.slopes, residuals_of_pose.residuals)
        diagonal = np.einsum("fuu->fu", normal)
        diagonal += damping[:, None] * (diagonal + 1.0)
        step = -np.linalg.solve(normal, slope[..., None])[..., 0]
        tried = apply_step(body, poses, step)
        new_cost = cost_of(body, observed, tried)
        better = new_cost < cost
        poses = Poses(
            np.where(better[:, None, None, None], tried.rotations, poses.rotations),
            np.where(better[:, None], tried.roots, poses.roots),
        )
        settled = (cost - new_cost)[better] <= MIN_COST_GAIN * cost[better]
        cost = np.where(better, new_cost, cost)
        damping = np.where(better, damping / DAMPING_FALL, damping * DAMPING_RISE)
        if settled.all() and better.mean() > 0.5:
            break
    return poses


def apply_step(body: MarkerBody, poses: Poses, step: Array) -> Poses:
    """Return poses after a step, shape (n_frames, 3 + 3 per rotating joint)."""
    rotations = poses.rotations.copy()
    vectors = step[:, 3:].reshape(len(step), -1, 3)
    size = np.linalg.norm(vectors, axis=-1).max(axis=1).clip(min=MAX_STEP_RAD)
    vectors = vectors * (MAX_STEP_RAD / size)[:, None, None]
    rotations[:, body.rotating_joints] = (
        matrix_from_rotation_vector(vectors) @ rotations[:, body.rotating_joints]
    )
    return Poses(rotations, poses.roots + step[:, :3])


def cost_of(body: MarkerBody, observed: Array, poses: Poses) -> Array:
    """Return the cost of each pose, shape (n_frames,)."""
    residuals_of_markers = _marker_residuals(body, observed, body.body_in_pose(poses))
    square = (residuals_of_markers**2).sum(axis=-1) / CAUCHY_SCALE**2
    prior_residuals, _ = _prior_residuals(body, poses)
    return np.asarray(
        CAUCHY_SCALE**2 * np.log1p(square).sum(axis=1) + (prior_residuals**2).sum(axis=1)
    )


def compute_residuals(body: MarkerBody, observed: Array, poses: Poses) -> Residuals:
    """Return the weighted residuals of markers, then those of the joint priors.

    `observed` has the shape (n_frames, n_markers, 3), meters; NaN where missing.
    """
    world = body.body_in_pose(poses)
    residuals_of_markers = _marker_residuals(body, observed, world)
    square = (residuals_of_markers**2).sum(axis=-1, keepdims=True) / CAUCHY_SCALE**2
    weight = 1.0 / np.sqrt(1.0 + square) / body.noise[:, None]
    weight = np.where(np.isfinite(observed).all(axis=-1, keepdims=True), weight, 0.0)
    marker_jacobian = weight[..., None] * marker_slopes(body, world)
    prior_residuals, prior_slopes = _prior_residuals(body, poses)
    n_frames, n_markers = residuals_of_markers.shape[:2]
    residuals = (residuals_of_markers * weight * body.noise[:, None]).reshape(n_frames, -1)
    return Residuals(
        np.concatenate([residuals, prior_residuals], axis=1),
        np.concatenate(
            [marker_jacobian.reshape(n_frames, 3 * n_markers, -1), prior_slopes], axis=1
        ),
        weight,
        world,
    )


def _marker_residuals(body: MarkerBody, observed: Array, world: WorldBody) -> Array:
    """Return the residual of each marker, in units of its noise; 0 where it is missing."""
    return np.nan_to_num((world.markers - observed) / body.noise[:, None])


def marker_slopes(body: MarkerBody, world: WorldBody) -> Array:
    """Return the Jacobian of the markers, shape (n_frames, n_markers, 3, n_unknowns).

    The rotation of a joint is a small rotation vector in its parent's axes.
    """
    n_frames, n_markers = world.markers.shape[:2]
    slopes = np.zeros((n_frames, n_markers, 3, 1 + len(body.rotating_joints), 3))
    slopes[:, :, :, 0] = np.eye(3)
    number = {int(joint): index for index, joint in enumerate(body.rotating_joints, start=1)}
    for joint, index in number.items():
        below = [m for m in range(n_markers) if joint in body.path(int(body.bones[m]))]
        parent = body.parents[joint]
        axes = world.frames[:, parent] if parent >= 0 else np.eye(3)[None]
        arms = world.markers[:, below] - world.joints[:, [joint]]
        slopes[:, :, :, index][:, below] = -skew_matrices(arms) @ axes[:, None]
    return slopes.reshape(n_frames, n_markers, 3, -1)


def _prior_residuals(body: MarkerBody, poses: Poses) -> tuple[Array, Array]:
    """Return residuals and derivatives of the joint priors."""
    n_unknowns = 3 + 3 * len(body.rotating_joints)
    residuals, slopes = [], []
    for number, joint in enumerate(body.rotating_joints):
        prior = body.joints[joint]
        for widths, residuals_of_pose in (
            (prior.ease, _rotation_vectors),
            (prior.hinge, _hinge_axes),
        ):
            used = np.flatnonzero(widths)
            if not len(used):
                continue
            value, slope = residuals_of_pose(poses.rotations[:, joint])
            width = np.array(widths)[used]
            row = np.zeros((len(value), len(used), n_unknowns))
            row[:, :, 3 + 3 * number : 6 + 3 * number] = slope[:, used] / width[:, None]
            residuals.append(value[:, used] / width)
            slopes.append(row)
    return np.concatenate(residuals, axis=1), np.concatenate(slopes, axis=1)


def _rotation_vectors(rotations: Array) -> tuple[Array, Array]:
    """Return rotation vectors, and their derivatives by a small rotation."""
    vectors = rotation_vector_from_quaternion(quaternion_from_matrix(rotations))
    angle = np.linalg.norm(vectors, axis=-1)[:, None, None]
    small = angle < 1e-4
    safe = np.where(small, 1.0, angle)
    factor = 1.0 / safe**2 - (1.0 + np.cos(safe)) / (2.0 * safe * np.sin(safe) + 1e-9)
    skew = skew_matrices(vectors)
    return vectors, np.eye(3) - 0.5 * skew + np.where(small, 1.0 / 12.0, factor) * skew @ skew


def _hinge_axes(rotations: Array) -> tuple[Array, Array]:
    """Return the deviation of a joint's X axis from its parent's, and its derivatives."""
    axis = rotations[:, :, 0]
    return axis - np.array([1.0, 0.0, 0.0]), -skew_matrices(axis)
