"""Skeletons, motions and tracks: what all families pass to each other, and its kinematics."""

from .depth_sensors import JOINTS, UI_PRMD, Sensor, joint_parents, rest_direction
from .frame_rate import check_frame_rate
from .joint_limits import ROTATION_VECTOR, JointLimits, load_joint_limits
from .joint_recording import INFERRED, TRACKED, JointRecording
from .kinematics import WorldPoses, forward_kinematics, local_rotations, world_poses
from .limb_ik import ReachSettings, reach
from .mediapipe import BODY, CENTRES, HAND
from .motion import Motion
from .resampling import resample
from .shot_boundaries import find_cuts, is_short, pieces, tell_of_cuts
from .skeleton import Skeleton
from .tracks import Tracks
from .velocities import angular_velocities, linear_velocities
from .warping import Alignment, warp

__all__ = [
    "BODY",
    "CENTRES",
    "HAND",
    "INFERRED",
    "JOINTS",
    "ROTATION_VECTOR",
    "TRACKED",
    "UI_PRMD",
    "Alignment",
    "JointLimits",
    "JointRecording",
    "Motion",
    "ReachSettings",
    "Sensor",
    "Skeleton",
    "Tracks",
    "WorldPoses",
    "angular_velocities",
    "check_frame_rate",
    "find_cuts",
    "forward_kinematics",
    "is_short",
    "joint_parents",
    "linear_velocities",
    "load_joint_limits",
    "local_rotations",
    "pieces",
    "reach",
    "resample",
    "rest_direction",
    "tell_of_cuts",
    "warp",
    "world_poses",
]
