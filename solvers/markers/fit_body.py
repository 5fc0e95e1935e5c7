"""Fit the dimensions of a body together with the poses of some frames."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..progress import Progress, unwatched
from .body import MarkerBody, Poses, WorldBody
from .fit_poses import (
    DAMPING,
    DAMPING_FALL,
    DAMPING_RISE,
    apply_step,
    compute_residuals,
    cost_of,
)

N_INDEPENDENT_FRAMES = 10.0
"""Effective number of independent frames of a take: skin motion correlates with the pose.
Chosen by hand; `make sensitivity` varies it."""
MAX_STEPS = 25
"""Maximum number of Gauss-Newton steps. It bounds the run time: bodies of the test takes
converge sooner."""
MIN_COST_GAIN = 1e-3
"""Relative gain of the cost below which the iteration ends. It bounds the run time."""


class Measures(NamedTuple):
    """Free dimensions of a body: one parameter for the joints of both sides."""

    joints: list[list[tuple[int, int, float]]]
    """For each parameter, the affected joints, coordinates and signs."""
    joint_play: Array
    markers: list[tuple[int, int]]
    """Marker and coordinate that each further parameter affects."""
    marker_play: Array

    @property
    def play(self) -> Array:
        """Prior standard deviation of each parameter, meters."""
        return np.concatenate([self.joint_play, self.marker_play])


def fit_body(
    body: MarkerBody, observed: Array, poses: Poses, *, progress: Progress = unwatched
) -> tuple[MarkerBody, Poses]:
    """Fit joint offsets, marker offsets and poses together.

    Joints become the centers of rotation of the complete chain, as in [1]_ and [2]_; a joint
    that a take hardly rotates keeps its mean offset. Levenberg-Marquardt on the normal
    equations, with the poses eliminated (Schur complement).

    Parameters
    ----------
    body : MarkerBody
    observed : shape (n_frames, n_markers, 3), meters
    poses : Poses
        Initial poses of the same frames.
    progress : Progress

    References
    ----------
    .. [1] Reinbolt et al. (2005). Determination of patient-specific multi-joint kinematic
       models through two-level optimization. doi:10.1016/j.jbiomech.2004.03.031
    .. [2] Ehrig, Taylor, Duda, Heller (2006). A survey of formal methods for determining the
       centre of rotation of ball joints. doi:10.1016/j.jbiomech.2005.10.002
    """
    measures = measures_of(body)
    play = measures.play / np.sqrt(max(1.0, len(observed) / N_INDEPENDENT_FRAMES))
    values, prior, damping = np.zeros(len(play)), body, DAMPING
    cost = _cost(body, observed, poses, values / play)
    for number in range(MAX_STEPS):
        progress(number / MAX_STEPS, "Measuring the body")
        step, pose_step = _step(body, observed, poses, measures, play, values, damping)
        candidate_values = values + step
        candidate = _body_from_values(prior, measures, candidate_values)
        candidate_poses = apply_step(body, poses, pose_step)
        new_cost = _cost(candidate, observed, candidate_poses, candidate_values / play)
        if new_cost >= cost:
            damping *= DAMPING_RISE
            continue
        converged = cost - new_cost < MIN_COST_GAIN * cost
        body, poses, values, cost = candidate, candidate_poses, candidate_values, new_cost
        damping /= DAMPING_FALL
        if converged:
            break
    progress(1.0, "Measuring the body")
    return body, poses


def measures_of(body: MarkerBody) -> Measures:
    """Return the free dimensions of a body, with the priors of its joints and markers."""
    joints, joint_play = [], []
    for index, joint in enumerate(body.joints):
        if joint.name.startswith("right") and "left" + joint.name[5:] in body.index:
            continue
        opposite = body.index.get("right" + joint.name.removeprefix("left"))
        for axis, play in enumerate(joint.play):
            if play:
                affected = [(index, axis, 1.0)]
                if joint.name.startswith("left") and opposite is not None:
                    affected.append((opposite, axis, -1.0 if axis == 0 else 1.0))
                joints.append(affected)
                joint_play.append(play)
    markers = [(index, axis) for index in range(len(body.markers)) for axis in range(3)]
    marker_play = np.repeat([marker.play for marker in body.markers], 3)
    return Measures(joints, np.array(joint_play), markers, marker_play)


def _cost(body: MarkerBody, observed: Array, poses: Poses, deviations: Array) -> float:
    return float(cost_of(body, observed, poses).sum() + (deviations**2).sum())


def _step(
    body: MarkerBody,
    observed: Array,
    poses: Poses,
    measures: Measures,
    play: Array,
    values: Array,
    damping: float,
) -> tuple[Array, Array]:
    """Return the steps of the dimensions and of the poses."""
    residuals = compute_residuals(body, observed, poses)
    by_body = np.zeros((*residuals.residuals.shape, len(play)))
    n_markers = observed.shape[1]
    affected = residuals.weights[..., None] * body_slopes(body, residuals.world, measures)
    by_body[:, : 3 * n_markers] = affected.reshape(len(observed), 3 * n_markers, -1)
    by_pose = np.swapaxes(residuals.slopes, 1, 2)
    poses_normal = by_pose @ residuals.slopes
    diagonal = np.einsum("fuu->fu", poses_normal)
    diagonal += damping * (diagonal + 1.0)
    cross = by_pose @ by_body
    gradient = np.einsum("fur,fr->fu", by_pose, residuals.residuals)
    solved = np.linalg.solve(poses_normal, np.concatenate([cross, gradient[..., None]], axis=2))
    flat = by_body.reshape(-1, len(play))
    normal = flat.T @ flat + np.diag(play**-2.0) * (1.0 + damping)
    normal = normal - np.einsum("fus,fut->st", cross, solved[..., :-1], optimize=True)
    slope = flat.T @ residuals.residuals.ravel() + values / play**2
    slope = slope - np.einsum("fus,fu->s", cross, solved[..., -1])
    step = -np.linalg.solve(normal, slope)
    return step, -solved[..., -1] - solved[..., :-1] @ step


def body_slopes(body: MarkerBody, world: WorldBody, measures: Measures) -> Array:
    """Return the Jacobian of the markers, (n_frames, n_markers, 3, n_measures)."""
    n_frames, n_markers = world.markers.shape[:2]
    slopes = np.zeros((n_frames, n_markers, 3, len(measures.play)))
    for number, affected in enumerate(measures.joints):
        for joint, axis, sign in affected:
            along = sign * world.frames[:, body.parents[joint], :, axis]
            for marker, anchor in enumerate(body.anchors):
                if joint in body.path(int(anchor)):
                    slopes[:, marker, :, number] += along
    first = len(measures.joints)
    for number, (marker, axis) in enumerate(measures.markers, start=first):
        slopes[:, marker, :, number] = world.frames[:, body.bones[marker], :, axis]
    return slopes


def _body_from_values(prior: MarkerBody, measures: Measures, values: Array) -> MarkerBody:
    offsets, marker_offsets = prior.offsets.copy(), prior.marker_offsets.copy()
    for affected, value in zip(measures.joints, values, strict=False):
        for joint, axis, sign in affected:
            offsets[joint, axis] += sign * value
    return prior.with_offsets(
        offsets, marker_offsets + values[len(measures.joints) :].reshape(-1, 3)
    )
