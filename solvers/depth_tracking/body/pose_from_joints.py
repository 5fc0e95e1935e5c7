"""Pose a body so that its joints, or points on its segments, lie where they were found."""

import numpy as np
from numpy.typing import NDArray

from .coordinates import COORDINATES, N_COORDINATES, N_ROOT
from .kinematics import segment_frames, segment_twists
from .model import BodyModel
from .normal_equations import (
    equations_in_coordinates,
    equations_toward_targets,
    solve_step,
    sum_equations,
)
from .pose_priors import joint_limits, stay_near
from .tables import END_SEGMENTS, JOINTS, SEGMENTS

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

_CARRIERS = np.array([*range(len(SEGMENTS)), *END_SEGMENTS])
_YAW = COORDINATES.index("yaw")
_REST_WEIGHT = 1e-3
_LIMIT_WEIGHT = 1.0
_LONGEST_STEP = 0.5
_SURE = 100.0
_CORNERS = 0.05 * np.array([*np.eye(3), *-np.eye(3)])
"""Points of a segment, metres, that tell how it is turned; farther ones would tell more."""


def pose_from_joints(
    body: BodyModel, joints: Array, *, start: Array | None = None, iterations: int = 40
) -> Array:
    """Return the pose (36,) of the body whose joints are nearest to these.

    Parameters
    ----------
    body : BodyModel
    joints : shape (21, 3), metres
        The `JOINTS` in the camera's frame; NaN: unknown.
    start : shape (36,), optional
        A pose near it, such as that of the frame before; without, four headings are tried.
    iterations : int
    """
    known = np.flatnonzero(np.isfinite(joints).all(axis=1))
    local = _joints_on_segments(body)
    return pose_from_points(
        body, _CARRIERS[known], local[known], joints[known],
        np.ones(len(known)), start=start, iterations=iterations,
    )  # fmt: skip


def pose_from_frames(
    body: BodyModel, frames: Array, *, start: Array | None = None, iterations: int = 40
) -> Array:
    """Return the pose (36,) of the body whose segments are nearest to where these are.

    Where its coordinates cannot turn them so, joints are rather in their places.

    Parameters
    ----------
    body : BodyModel
    frames : shape (17, 4, 4)
        camera_from_segment of the `SEGMENTS`; turns that a joint cannot make are not followed.
    start : shape (36,), optional
    iterations : int
    """
    corners = np.tile(_CORNERS, (len(SEGMENTS), 1))
    local = np.concatenate([_joints_on_segments(body), corners])
    segments = np.repeat(np.arange(len(SEGMENTS)), len(_CORNERS))
    segments = np.concatenate([_CARRIERS, segments])
    carriers = frames[segments]
    targets = np.einsum("nij,nj->ni", carriers[:, :3, :3], local) + carriers[:, :3, 3]
    weights = np.full(len(segments), _SURE)
    return pose_from_points(
        body, segments, local, targets, weights, start=start, iterations=iterations
    )


def pose_from_points(
    body: BodyModel,
    segments: Integers,
    local: Array,
    targets: Array,
    weights: Array,
    *,
    start: Array | None = None,
    iterations: int = 40,
) -> Array:
    """Return the pose (36,) that brings points on segments nearest to targets.

    Joint limits hold softly, and what no point tells stays near the pose of zeros.
    Without a start, four headings are tried.

    Parameters
    ----------
    body : BodyModel
    segments : int, shape (n,)
        Index of the segment that carries each point.
    local : shape (n, 3), metres
        The points in the frames of their segments.
    targets : shape (n, 3), metres
        Where they should be, camera frame.
    weights : shape (n,)
        Of the squares; 1 for a point that is sure.
    start : shape (36,), optional
    iterations : int
    """
    starts = [start] if start is not None else _starts(targets)
    found = [
        _descend(body, pose, (segments, local, targets, weights), iterations) for pose in starts
    ]
    return min(found, key=lambda one: one[1])[0]


def _joints_on_segments(body: BodyModel) -> Array:
    """Return the `JOINTS` (21, 3) in the frames of the segments that carry them."""
    return np.concatenate([np.zeros((len(SEGMENTS), 3)), body.offsets[len(SEGMENTS) :]])


def _starts(targets: Array) -> list[Array]:
    starts = []
    for yaw in np.arange(4) * np.pi / 2:
        pose = np.zeros(N_COORDINATES)
        pose[:3], pose[_YAW] = targets.mean(axis=0), yaw
        starts.append(pose)
    return starts


def _descend(
    body: BodyModel, pose: Array, points: tuple[Integers, Array, Array, Array], iterations: int
) -> tuple[Array, float]:
    segments, local, targets, weights = points
    damping, best = 1e-2, (pose, np.inf)
    equations = None
    for _ in range(iterations):
        frames = segment_frames(body, pose)
        carrier = frames[segments]
        places = np.einsum("nij,nj->ni", carrier[:, :3, :3], local) + carrier[:, :3, 3]
        pulls = equations_toward_targets(places, targets, weights, segments)
        found = sum_equations([
            equations_in_coordinates([pulls], segment_twists(pose, frames)),
            joint_limits(pose, _LIMIT_WEIGHT), stay_near(pose, _rest(pose), _REST_WEIGHTS),
        ])  # fmt: skip
        if equations is None or found.cost < best[1]:
            equations, best, damping = found, (pose, found.cost), 0.3 * damping
        else:
            damping = 10.0 * damping
        change = solve_step(equations, np.full(N_COORDINATES, max(damping, 1e-9)))
        pose = best[0] + change * min(1.0, _LONGEST_STEP / np.abs(change).max())
        if np.abs(change).max() < 1e-7:
            break
    return best


_REST_WEIGHTS = np.array([0.0] * N_ROOT + [_REST_WEIGHT] * (N_COORDINATES - N_ROOT))


def _rest(pose: Array) -> Array:
    rest = np.zeros(N_COORDINATES)
    rest[:N_ROOT] = pose[:N_ROOT]
    return rest


def body_from_joints(body: BodyModel, joints: Array) -> BodyModel:
    """Return the body with limbs as long as recorded joints are apart.

    Parameters
    ----------
    body : BodyModel
        Its radii and what joints do not tell (hands, feet, head) are kept.
    joints : shape (n_frames, 21, 3), metres
        The `JOINTS`; NaN: unknown.
    """
    lengths = {}
    for side in ("left", "right"):
        for length, below in (
            ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
            ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"),
        ):  # fmt: skip
            lengths[f"{side}{length}"] = _apart(joints, f"{side}{length}", f"{side}{below}")
    lengths["hipWidth"] = 0.5 * _apart(joints, "leftUpperLeg", "rightUpperLeg")
    width = 0.5 * _apart(joints, "leftUpperArm", "rightUpperArm")
    lengths["leftShoulder"] = lengths["rightShoulder"] = width / 1.1
    trunk = _apart(joints, "hips", "neck")
    usual = sum(body.length(name) for name in ("hips", "spine", "chest"))
    for name in ("hips", "spine", "chest"):
        lengths[name] = body.length(name) * trunk / usual
    told = {name: length for name, length in lengths.items() if np.isfinite(length)}
    return body.with_lengths(**told)


def _apart(joints: Array, first: str, second: str) -> float:
    between = joints[:, JOINTS.index(first)] - joints[:, JOINTS.index(second)]
    distances = np.linalg.norm(between, axis=-1)
    distances = distances[np.isfinite(distances)]
    return float(np.median(distances)) if len(distances) else np.nan
