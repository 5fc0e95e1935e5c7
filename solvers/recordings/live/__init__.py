"""Receive a live stream of joints or bones over the local network."""

from .frames import (
    FORMAT,
    MAX_JOINTS,
    PORT,
    LiveFrame,
    encode_frame,
    frames_from_recording,
)
from .pose_frames import PoseFrame, joints_from_pose, measured_rate, motion_from_poses
from .receiver import LOOPBACK, Receiver, allowed_networks
from .stream import (
    FrameDecoder,
    JointLines,
    StreamCounts,
    StreamFrame,
    StreamReader,
    recording_from_frames,
)

__all__ = [
    "FORMAT",
    "LOOPBACK",
    "MAX_JOINTS",
    "PORT",
    "FrameDecoder",
    "JointLines",
    "LiveFrame",
    "PoseFrame",
    "Receiver",
    "StreamCounts",
    "StreamFrame",
    "StreamReader",
    "allowed_networks",
    "encode_frame",
    "frames_from_recording",
    "joints_from_pose",
    "measured_rate",
    "motion_from_poses",
    "recording_from_frames",
]
