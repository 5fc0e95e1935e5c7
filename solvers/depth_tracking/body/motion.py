"""Poses of a body model as a motion of the scene: Z up, a T-pose at rest, humanoid roles."""

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Floor
from ...motion import Motion, Skeleton
from ...rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_matrix,
    unroll,
)
from .kinematics import N_SEGMENTS, matrix_from_rotation_vector, segment_frames
from .model import BodyModel
from .tables import END_SEGMENTS, JOINTS, PARENTS, SEGMENTS

Array = NDArray[np.float64]

SCENE_FROM_CAMERA = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Of a level camera that looks along +Y: who faces it faces -Y."""
JOINT_PARENTS = (*PARENTS, *END_SEGMENTS)


def _t_pose_turns() -> Array:
    """Return how each segment is turned in the T-pose, camera frame: arms out to the sides."""
    turned = []
    for segment in SEGMENTS:
        arm = segment.endswith(("UpperArm", "LowerArm"))
        out = -1.0 if segment.startswith("left") else 1.0
        turned.append(
            matrix_from_rotation_vector(np.array([0.0, 0.0, out * arm * np.pi / 2.0]))
        )
    return np.stack(turned)


_T_POSE = _t_pose_turns()
_REST = SCENE_FROM_CAMERA @ _T_POSE
"""How each segment is turned in the rest pose, (17, 3, 3)."""


def body_skeleton(body: BodyModel) -> Skeleton:
    """Return the skeleton of a body in the T-pose, its soles on the floor, facing -Y."""
    turned = _T_POSE
    offsets = np.empty((len(JOINTS), 3))
    for joint, parent in enumerate(JOINT_PARENTS):
        carried = np.eye(3) if parent < 0 else turned[parent]
        offsets[joint] = SCENE_FROM_CAMERA @ carried @ body.offsets[joint]
    legs = [body.length(f"left{part}") for part in ("UpperLeg", "LowerLeg")]
    offsets[0] = (0.0, 0.0, sum(legs) + 0.25 * body.length("leftFoot"))
    return Skeleton(JOINTS, JOINT_PARENTS, offsets)


def body_motion(
    body: BodyModel, poses: Array, frame_rate: float, floor: Floor | None = None
) -> Motion:
    """Return the motion of a body in poses (n_frames, 36).

    Parameters
    ----------
    body : BodyModel
    poses : shape (n_frames, 36)
    frame_rate : float, hertz
    floor : Floor, optional
        It becomes the plane z = 0, and its normal Z. Without it the camera is taken to be
        level, at the origin.
    """
    frames = segment_frames(body, poses)
    scene = scene_from_camera(floor)
    world = scene[:3, :3] @ frames[..., :3, :3] @ _REST.swapaxes(1, 2)
    rotations = quaternion_from_matrix(world)
    local = np.tile([1.0, 0.0, 0.0, 0.0], (len(poses), len(JOINTS), 1))
    local[:, 0] = rotations[:, 0]
    above = list(PARENTS[1:])
    local[:, 1:N_SEGMENTS] = multiply(inverse(rotations[:, above]), rotations[:, 1:])
    places = frames[:, 0, :3, 3] @ scene[:3, :3].T + scene[:3, 3]
    return Motion(body_skeleton(body), unroll(local), places, frame_rate)


def rest_frames(body: BodyModel) -> Array:
    """Return where the segments (17, 4, 4) are in the rest pose of `body_skeleton`."""
    frames = np.zeros((N_SEGMENTS, 4, 4))
    frames[:, :3, :3] = _REST
    frames[:, :3, 3] = body_skeleton(body).rest_positions[:N_SEGMENTS]
    frames[:, 3, 3] = 1.0
    return frames


def motion_frames(body: BodyModel, motion: Motion, floor: Floor | None = None) -> Array:
    """Undo `body_motion`: return where the segments of a body are in a motion of it.

    Parameters
    ----------
    body : BodyModel
    motion : Motion
        On the skeleton of the body; poses that no coordinates can reach are fine.
    floor : Floor, optional
        The one that is z = 0.

    Returns
    -------
    array, shape (n_frames, 17, 4, 4)
        camera_from_segment of each of the `SEGMENTS`; joints are as far apart as in the body.
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
        way = frames[:, parent, :3, :3] @ body.offsets[segment]
        frames[:, segment, :3, 3] = frames[:, parent, :3, 3] + way
    return frames


def scene_from_camera(floor: Floor | None) -> Array:
    """Return the transform (4, 4) from the camera's frame to a scene with Z up.

    A camera that is rolled does not look exactly along +Y then, as it does for
    `Floor.world_from_camera`: who mixes the two goes through the camera's frame.
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
