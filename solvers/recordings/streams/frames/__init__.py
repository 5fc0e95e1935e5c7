"""Frames of a stream, of joints or of bones, and the order that they come in."""

from ...identities import MAX_PEOPLE
from .joint_frames import (
    FORMAT,
    MAX_JOINTS,
    PORT,
    LiveFrame,
    encode_frame,
    frames_from_recording,
)
from .pose_frames import PoseFrame, joints_from_pose, measured_rate, motion_from_poses
from .stream_reader import (
    FrameDecoder,
    JointLines,
    StreamCounts,
    StreamFrame,
    StreamReader,
    recording_from_frames,
)

__all__ = [
    "FORMAT",
    "MAX_JOINTS",
    "MAX_PEOPLE",
    "PORT",
    "FrameDecoder",
    "JointLines",
    "LiveFrame",
    "PoseFrame",
    "StreamCounts",
    "StreamFrame",
    "StreamReader",
    "encode_frame",
    "frames_from_recording",
    "joints_from_pose",
    "measured_rate",
    "motion_from_poses",
    "recording_from_frames",
]
