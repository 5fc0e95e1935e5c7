"""Poses of a body model as a motion of the scene: Z up, a T-pose at rest, humanoid roles."""

import numpy as np

from ...arrays import Array
from ...depth_scene import FloorPlane
from ...motion import Motion, Skeleton
from ...rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_matrix,
    unroll,
)
from .model import BodyModel
from .segment_kinematics import N_SEGMENTS, matrix_from_rotation_vector, segment_frames
from .tables import END_SEGMENTS, JOINTS, PARENTS, SEGMENTS

SCENE_FROM_CAMERA = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Level camera that looks along +Y: an actor who faces it faces -Y."""
JOINT_PARENTS = (*PARENTS, *END_SEGMENTS)


def _t_pose_rotations() -> Array:
    """Return the rotation of each segment in the T-pose, camera frame."""
    rotations = []
    for segment in SEGMENTS:
        arm = segment.endswith(("UpperArm", "LowerArm"))
        out = -1.0 if segment.startswith("left") else 1.0
        rotations.append(
            matrix_from_rotation_vector(np.array([0.0, 0.0, out * arm * np.pi / 2.0]))
        )
    return np.stack(rotations)


_T_POSE = _t_pose_rotations()
_REST = SCENE_FROM_CAMERA @ _T_POSE
"""Rotation of each segment in the rest pose, (17, 3, 3)."""


def body_skeleton(body: BodyModel) -> Skeleton:
    """Return the skeleton of a body in the T-pose, its soles on the floor, facing -Y."""
    rotations = _T_POSE
    offsets = np.empty((len(JOINTS), 3))
    for joint, parent in enumerate(JOINT_PARENTS):
        parent_rotation = np.eye(3) if parent < 0 else rotations[parent]
        offsets[joint] = SCENE_FROM_CAMERA @ parent_rotation @ body.offsets[joint]
    legs = [body.length(f"left{part}") for part in ("UpperLeg", "LowerLeg")]
    offsets[0] = (0.0, 0.0, sum(legs) + 0.25 * body.length("leftFoot"))
    return Skeleton(JOINTS, JOINT_PARENTS, offsets)


def body_motion(
    body: BodyModel, poses: Array, frame_rate: float, floor: FloorPlane | None = None
) -> Motion:
    """Return the motion of a body in poses (n_frames, 36).

    Parameters
    ----------
    body : BodyModel
    poses : shape (n_frames, 36)
    frame_rate : float, hertz
    floor : FloorPlane, optional
        Becomes the plane z = 0, and its normal Z. Default: a level camera at the origin.
    """
    frames = segment_frames(body, poses)
    scene = scene_from_camera(floor)
    world = scene[:3, :3] @ frames[..., :3, :3] @ _REST.swapaxes(1, 2)
    rotations = quaternion_from_matrix(world)
    local = np.tile([1.0, 0.0, 0.0, 0.0], (len(poses), len(JOINTS), 1))
    local[:, 0] = rotations[:, 0]
    parents = list(PARENTS[1:])
    local[:, 1:N_SEGMENTS] = multiply(inverse(rotations[:, parents]), rotations[:, 1:])
    positions = frames[:, 0, :3, 3] @ scene[:3, :3].T + scene[:3, 3]
    return Motion(body_skeleton(body), unroll(local), positions, frame_rate)


def rest_frames(body: BodyModel) -> Array:
    """Return the segment transforms (17, 4, 4) in the rest pose of `body_skeleton`."""
    frames = np.zeros((N_SEGMENTS, 4, 4))
    frames[:, :3, :3] = _REST
    frames[:, :3, 3] = body_skeleton(body).rest_positions[:N_SEGMENTS]
    frames[:, 3, 3] = 1.0
    return frames


def motion_frames(body: BodyModel, motion: Motion, floor: FloorPlane | None = None) -> Array:
    """Invert `body_motion`: return the segment transforms of a body in a motion.

    Parameters
    ----------
    body : BodyModel
    motion : Motion
        On the skeleton of the body; coordinates need not reach its poses.
    floor : FloorPlane, optional
        The plane z = 0.

    Returns
    -------
    array, shape (n_frames, 17, 4, 4)
        camera_from_segment of each of the `SEGMENTS`; joint distances equal those of the body.
    """
    camera = np.linalg.inv(scene_from_camera(floor))
    world = motion.rotations[:, :N_SEGMENTS].copy()
    for segment, parent in enumerate(PARENTS[1:], start=1):
        world[:, segment] = multiply(world[:, parent], world[:, segment])
    frames = np.zeros((motion.n_frames, N_SEGMENTS, 4, 4))
    frames[..., 3, 3] = 1.0
    frames[..., :3, :3] = camera[:3, :3] @ matrix_from_quaternion(world) @ _REST
    frames[:, 0, :3, 3] = motion.root_positions @ camera[:3, :3].T + camera[:3, 3]
    for segment, parent in enumerate(PARENTS[1:], start=1):
        offset = frames[:, parent, :3, :3] @ body.offsets[segment]
        frames[:, segment, :3, 3] = frames[:, parent, :3, 3] + offset
    return frames


def scene_from_camera(floor: FloorPlane | None) -> Array:
    """Return the transform (4, 4) from the camera's frame to a scene with Z up.

    A rolled camera does not look exactly along +Y, unlike in `FloorPlane.world_from_camera`.
    Convert between the two through the camera frame.
    """
    scene = np.eye(4)
    scene[:3, :3] = SCENE_FROM_CAMERA
    if floor is None:
        return scene
    up = SCENE_FROM_CAMERA @ floor.up
    axis = np.cross(up, [0.0, 0.0, 1.0])
    sine = np.linalg.norm(axis)
    if sine > 0.0:
        level = matrix_from_rotation_vector(axis / sine * np.arctan2(sine, up[2]))
        scene[:3, :3] = level @ SCENE_FROM_CAMERA
    scene[2, 3] = float(floor.heights(np.zeros(3)))
    return scene
