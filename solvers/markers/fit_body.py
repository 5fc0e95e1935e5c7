"""Find the measures of a body, that all frames share, along with the poses of some frames."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress, unwatched
from .body import Body, Placed, Poses
from .fit_poses import cost_of, stepped, wrong_by

Array = NDArray[np.float64]
INDEPENDENT = 10.0
"""Frames that tell as much as a whole take: skin moves alike in frames of like poses."""
MOST_STEPS = 25
DAMPING = 1e-3
SETTLED = 1e-3


class Measures(NamedTuple):
    """What of a body may be other than usual: one number for a joint of both sides."""

    joints: list[list[tuple[int, int, float]]]
    """For each number the joints, coordinates and signs that it moves."""
    joint_play: Array
    markers: list[tuple[int, int]]
    """Marker and coordinate that each further number moves."""
    marker_play: Array

    @property
    def play(self) -> Array:
        """Standard deviation of each number, metres."""
        return np.concatenate([self.joint_play, self.marker_play])


def fit_body(
    body: Body, seen: Array, poses: Poses, *, progress: Progress = unwatched
) -> tuple[Body, Poses]:
    """Fit joints, marker seats and poses at once, so that joints are where bones turn.

    Centres of rotation are those that the whole chain agrees on, as in [1]_ and [2]_; where a
    take hardly turns a joint, it stays where it usually is. By Levenberg-Marquardt on the
    normal equations, from which the poses are eliminated (Schur complement).

    Parameters
    ----------
    body : Body
    seen : shape (n_frames, n_markers, 3), metres
    poses : Poses
        Of the same frames, where to begin.
    progress : Progress

    References
    ----------
    .. [1] Reinbolt et al. (2005). Determination of patient-specific multi-joint kinematic
       models through two-level optimization. doi:10.1016/j.jbiomech.2004.03.031
    .. [2] Ehrig, Taylor, Duda, Heller (2006). A survey of formal methods for determining the
       centre of rotation of ball joints. doi:10.1016/j.jbiomech.2005.10.002
    """
    measures = measures_of(body)
    play = measures.play / np.sqrt(max(1.0, len(seen) / INDEPENDENT))
    values, usual, damping = np.zeros(len(play)), body, DAMPING
    cost = _cost(body, seen, poses, values / play)
    for number in range(MOST_STEPS):
        progress(number / MOST_STEPS, "Measuring the body")
        step, pose_step = _step(body, seen, poses, measures, play, values, damping)
        tried_values = values + step
        tried = _moved(usual, measures, tried_values)
        tried_poses = stepped(body, poses, pose_step)
        new_cost = _cost(tried, seen, tried_poses, tried_values / play)
        if new_cost >= cost:
            damping *= 8.0
            continue
        settled = cost - new_cost < SETTLED * cost
        body, poses, values, cost = tried, tried_poses, tried_values, new_cost
        damping /= 5.0
        if settled:
            break
    progress(1.0, "Measuring the body")
    return body, poses


def measures_of(body: Body) -> Measures:
    """Return what may be measured of a body, by the play of its joints and markers."""
    joints, joint_play = [], []
    for index, joint in enumerate(body.joints):
        if joint.name.startswith("right") and "left" + joint.name[5:] in body.place:
            continue
        twin = body.place.get("right" + joint.name.removeprefix("left"))
        for axis, play in enumerate(joint.play):
            if play:
                moved = [(index, axis, 1.0)]
                if joint.name.startswith("left") and twin is not None:
                    moved.append((twin, axis, -1.0 if axis == 0 else 1.0))
                joints.append(moved)
                joint_play.append(play)
    markers = [(index, axis) for index in range(len(body.markers)) for axis in range(3)]
    marker_play = np.repeat([marker.play for marker in body.markers], 3)
    return Measures(joints, np.array(joint_play), markers, marker_play)


def _cost(body: Body, seen: Array, poses: Poses, away: Array) -> float:
    return float(cost_of(body, seen, poses).sum() + (away**2).sum())


def _step(
    body: Body,
    seen: Array,
    poses: Poses,
    measures: Measures,
    play: Array,
    values: Array,
    damping: float,
) -> tuple[Array, Array]:
    """Return the steps of measures, and of poses."""
    wrong = wrong_by(body, seen, poses)
    by_body = np.zeros((*wrong.residuals.shape, len(play)))
    n_markers = seen.shape[1]
    moved = wrong.weights[..., None] * body_slopes(body, wrong.placed, measures)
    by_body[:, : 3 * n_markers] = moved.reshape(len(seen), 3 * n_markers, -1)
    by_pose = np.swapaxes(wrong.slopes, 1, 2)
    poses_normal = by_pose @ wrong.slopes
    diagonal = np.einsum("fuu->fu", poses_normal)
    diagonal += damping * (diagonal + 1.0)
    cross = by_pose @ by_body
    gradient = np.einsum("fur,fr->fu", by_pose, wrong.residuals)
    solved = np.linalg.solve(poses_normal, np.concatenate([cross, gradient[..., None]], axis=2))
    flat = by_body.reshape(-1, len(play))
    normal = flat.T @ flat + np.diag(play**-2.0) * (1.0 + damping)
    normal = normal - np.einsum("fus,fut->st", cross, solved[..., :-1], optimize=True)
    slope = flat.T @ wrong.residuals.ravel() + values / play**2
    slope = slope - np.einsum("fus,fu->s", cross, solved[..., -1])
    step = -np.linalg.solve(normal, slope)
    return step, -solved[..., -1] - solved[..., :-1] @ step


def body_slopes(body: Body, placed: Placed, measures: Measures) -> Array:
    """Return how markers move with the measures, (n_frames, n_markers, 3, n_measures)."""
    n_frames, n_markers = placed.markers.shape[:2]
    slopes = np.zeros((n_frames, n_markers, 3, len(measures.play)))
    for number, moved in enumerate(measures.joints):
        for joint, axis, sign in moved:
            along = sign * placed.frames[:, body.parents[joint], :, axis]
            for marker, anchor in enumerate(body.anchors):
                if joint in body.path(int(anchor)):
                    slopes[:, marker, :, number] += along
    first = len(measures.joints)
    for number, (marker, axis) in enumerate(measures.markers, start=first):
        slopes[:, marker, :, number] = placed.frames[:, body.bones[marker], :, axis]
    return slopes


def _moved(usual: Body, measures: Measures, values: Array) -> Body:
    offsets, seats = usual.offsets.copy(), usual.marker_offsets.copy()
    for moved, value in zip(measures.joints, values, strict=False):
        for joint, axis, sign in moved:
            offsets[joint, axis] += sign * value
    return usual.with_offsets(offsets, seats + values[len(measures.joints) :].reshape(-1, 3))
