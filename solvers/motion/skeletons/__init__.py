"""Skeletons, motions and tracks, the data that all families exchange, and kinematics."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .body_trackers import NUITRACK, ZED_BODIES
    from .depth_sensors import SENSOR_JOINTS, UI_PRMD, Sensor, joint_parents, rest_direction
    from .file_conventions import AxisName, FileConventions, unit_name
    from .frame_rate import MAX_FRAME_RATE_HZ, check_frame_rate
    from .ground import GROUND_WINDOW_S, MAX_CLIMB_M, ground_level
    from .joint_limits import ROTATION_VECTOR, JointLimits
    from .joint_recording import INFERRED, TRACKED, JointRecording
    from .kinematics import WorldPoses, forward_kinematics, local_rotations, world_poses
    from .limb_ik import ReachSettings, reach
    from .mediapipe import BODY_POINTS, COMPUTED_JOINTS, HAND_POINTS
    from .motion import Motion
    from .path_jumps import (
        MIN_JUMP_M,
        PathJump,
        find_path_jumps,
        move_root,
        path_offsets,
    )
    from .point_layouts import LAYOUTS
    from .resampling import resample
    from .shot_boundaries import (
        MIN_SHOT_S,
        describe_shots,
        find_shot_boundaries,
        is_short_shot,
        shot_ranges,
    )
    from .skeleton import MIN_BONE_M, Skeleton
    from .still_joints import still_joints
    from .tracks import Tracks
    from .warping import Alignment, warp

__all__ = [
    "BODY_POINTS",
    "COMPUTED_JOINTS",
    "GROUND_WINDOW_S",
    "HAND_POINTS",
    "INFERRED",
    "LAYOUTS",
    "MAX_CLIMB_M",
    "MAX_FRAME_RATE_HZ",
    "MIN_BONE_M",
    "MIN_JUMP_M",
    "MIN_SHOT_S",
    "NUITRACK",
    "ROTATION_VECTOR",
    "SENSOR_JOINTS",
    "TRACKED",
    "UI_PRMD",
    "ZED_BODIES",
    "Alignment",
    "AxisName",
    "FileConventions",
    "JointLimits",
    "JointRecording",
    "Motion",
    "PathJump",
    "ReachSettings",
    "Sensor",
    "Skeleton",
    "Tracks",
    "WorldPoses",
    "check_frame_rate",
    "describe_shots",
    "find_path_jumps",
    "find_shot_boundaries",
    "forward_kinematics",
    "ground_level",
    "is_short_shot",
    "joint_parents",
    "local_rotations",
    "move_root",
    "path_offsets",
    "reach",
    "resample",
    "rest_direction",
    "shot_ranges",
    "still_joints",
    "unit_name",
    "warp",
    "world_poses",
]

import_on_demand(__name__)
