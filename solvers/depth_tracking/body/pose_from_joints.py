"""Fit a pose to joints, segment transforms, or points on segments."""

import numpy as np

from ...arrays import Array, Integers
from ...motion.humanoid import SIDES
from .coordinates import COORDINATES, N_COORDINATES, N_ROOT
from .model import BodyModel
from .normal_equations import (
    equations_in_coordinates,
    equations_toward_targets,
    solve_step,
    sum_equations,
)
from .pose_priors import LIMIT_WEIGHT, MAX_STEP, joint_limits, stay_near
from .segment_kinematics import segment_frames, segment_twists
from .tables import END_SEGMENTS, JOINTS, LENGTHS, OFFSETS, SEGMENTS

_CARRIERS = np.array([*range(len(SEGMENTS)), *END_SEGMENTS])
_YAW = COORDINATES.index("yaw")
_REST_WEIGHT = 1e-3
"""Weight per square radian of the rest pose. Half and twice gain less than 1 %
(`make sensitivity`)."""
_FRAME_WEIGHT = 100.0
"""Weight per square meter of a joint's distance. Half and twice gain less than 1 %
(`make sensitivity`)."""
_SHOULDER_JOINTS = [JOINTS.index("leftShoulder"), JOINTS.index("leftUpperArm")]
_SHOULDER_RATIO = OFFSETS[_SHOULDER_JOINTS, 0, LENGTHS.index("leftShoulder")].sum()
"""Ratio of half the distance of the upper arms to a shoulder's length. By definition of the
offsets of both joints."""
_ROTATION_POINTS = 0.05 * np.array([*np.eye(3), *-np.eye(3)])
"""Points of a segment, meters, that constrain its rotation; larger offsets weigh more. Chosen
by hand: 5 cm is about the radius of a limb."""


def pose_from_joints(
    body: BodyModel, joints: Array, *, start: Array | None = None, iterations: int = 40
) -> Array:
    """Return the pose (36,) that minimizes the distances to joint positions.

    Parameters
    ----------
    body : BodyModel
    joints : shape (21, 3), meters
        The `JOINTS` in the camera frame; NaN: missing.
    start : shape (36,), optional
        Initial pose, such as the previous frame. Default: four headings are tested.
    iterations : int
    """
    observed = np.flatnonzero(np.isfinite(joints).all(axis=1))
    local = _joints_on_segments(body)
    return pose_from_points(
        body, _CARRIERS[observed], local[observed], joints[observed],
        np.ones(len(observed)), start=start, iterations=iterations,
    )  # fmt: skip


def pose_from_frames(
    body: BodyModel, frames: Array, *, start: Array | None = None, iterations: int = 40
) -> Array:
    """Return the pose (36,) that best matches segment transforms.

    If the coordinates cannot reach a rotation, joint positions take precedence.

    Parameters
    ----------
    body : BodyModel
    frames : shape (17, 4, 4)
        camera_from_segment of the `SEGMENTS`; unreachable rotations are approximated.
    start : shape (36,), optional
    iterations : int
    """
    points = np.tile(_ROTATION_POINTS, (len(SEGMENTS), 1))
    local = np.concatenate([_joints_on_segments(body), points])
    segments = np.repeat(np.arange(len(SEGMENTS)), len(_ROTATION_POINTS))
    segments = np.concatenate([_CARRIERS, segments])
    carriers = frames[segments]
    targets = np.einsum("nij,nj->ni", carriers[:, :3, :3], local) + carriers[:, :3, 3]
    weights = np.full(len(segments), _FRAME_WEIGHT)
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
    """Return the pose (36,) that moves points on segments to their targets.

    Joint limits are soft, and unobserved coordinates stay near the zero pose.
    Without a start, four headings are tested.

    Parameters
    ----------
    body : BodyModel
    segments : int, shape (n,)
        Index of the segment that carries each point.
    local : shape (n, 3), meters
        The points in the frames of their segments.
    targets : shape (n, 3), meters
        Target positions, camera frame.
    weights : shape (n,)
        Weights of the squares; 1 for a reliable point.
    start : shape (36,), optional
    iterations : int
    """
    initial_poses = [start] if start is not None else _initial_poses(targets)
    solutions = [
        _minimize(body, pose, (segments, local, targets, weights), iterations)
        for pose in initial_poses
    ]
    return min(solutions, key=lambda solution: solution[1])[0]


def _joints_on_segments(body: BodyModel) -> Array:
    """Return the `JOINTS` (21, 3) in the frames of the segments that carry them."""
    return np.concatenate([np.zeros((len(SEGMENTS), 3)), body.offsets[len(SEGMENTS) :]])


def _initial_poses(targets: Array) -> list[Array]:
    initial_poses = []
    for yaw in np.arange(4) * np.pi / 2:
        pose = np.zeros(N_COORDINATES)
        pose[:3], pose[_YAW] = targets.mean(axis=0), yaw
        initial_poses.append(pose)
    return initial_poses


def _minimize(
    body: BodyModel, pose: Array, points: tuple[Integers, Array, Array, Array], iterations: int
) -> tuple[Array, float]:
    segments, local, targets, weights = points
    damping, best = 1e-2, (pose, np.inf)
    equations = None
    for _ in range(iterations):
        frames = segment_frames(body, pose)
        carrier = frames[segments]
        positions = np.einsum("nij,nj->ni", carrier[:, :3, :3], local) + carrier[:, :3, 3]
        residual_equations = equations_toward_targets(positions, targets, weights, segments)
        total = sum_equations([
            equations_in_coordinates([residual_equations], segment_twists(pose, frames)),
            joint_limits(pose, LIMIT_WEIGHT), stay_near(pose, _rest_pose(pose), _REST_WEIGHTS),
        ])  # fmt: skip
        if equations is None or total.cost < best[1]:
            equations, best, damping = total, (pose, total.cost), 0.3 * damping
        else:
            damping = 10.0 * damping
        change = solve_step(equations, np.full(N_COORDINATES, max(damping, 1e-9)))
        pose = best[0] + change * min(1.0, MAX_STEP / np.abs(change).max())
        if np.abs(change).max() < 1e-7:
            break
    return best


_REST_WEIGHTS = np.array([0.0] * N_ROOT + [_REST_WEIGHT] * (N_COORDINATES - N_ROOT))


def _rest_pose(pose: Array) -> Array:
    rest = np.zeros(N_COORDINATES)
    rest[:N_ROOT] = pose[:N_ROOT]
    return rest


def body_from_joints(body: BodyModel, joints: Array) -> BodyModel:
    """Return the body with limb lengths measured from joint distances.

    Parameters
    ----------
    body : BodyModel
        Its radii and unmeasured lengths (hands, feet, head) are kept.
    joints : shape (n_frames, 21, 3), meters
        The `JOINTS`; NaN: missing.
    """
    lengths = {}
    for side in SIDES:
        for length, below in (
            ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
            ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"),
        ):  # fmt: skip
            lengths[f"{side}{length}"] = _median_distance(
                joints, f"{side}{length}", f"{side}{below}"
            )
    lengths["hipWidth"] = 0.5 * _median_distance(joints, "leftUpperLeg", "rightUpperLeg")
    width = 0.5 * _median_distance(joints, "leftUpperArm", "rightUpperArm")
    lengths["leftShoulder"] = lengths["rightShoulder"] = width / _SHOULDER_RATIO
    trunk = _median_distance(joints, "hips", "neck")
    default_trunk = sum(body.length(name) for name in ("hips", "spine", "chest"))
    for name in ("hips", "spine", "chest"):
        lengths[name] = body.length(name) * trunk / default_trunk
    measured = {name: length for name, length in lengths.items() if np.isfinite(length)}
    return body.with_lengths(**measured)


def _median_distance(joints: Array, first: str, second: str) -> float:
    offsets = joints[:, JOINTS.index(first)] - joints[:, JOINTS.index(second)]
    distances = np.linalg.norm(offsets, axis=-1)
    distances = distances[np.isfinite(distances)]
    return float(np.median(distances)) if len(distances) else np.nan
