"""Live streams: of VMC, mocopi, Xsens, Rokoko, MediaPipe, and our own JSON.

`frames` is what comes: joints or bones of one body at one time, in order. `protocols` is how
it is written. This folder receives, recognizes, reads and sends it.

>>> from solvers.recordings.streams import StreamProtocol, recognize_protocol
>>> recognize_protocol(b"/VMC/Ext/T") is StreamProtocol.VMC
True
"""

from .frames import (
    MAX_PEOPLE,
    PORT,
    LiveFrame,
    PoseFrame,
    StreamCounts,
    StreamFrame,
    StreamReader,
    encode_frame,
    frames_from_recording,
    joints_from_pose,
    measured_rate,
    motion_from_poses,
    recording_from_frames,
)
from .listener import ListenerState, StreamListener
from .protocols import StreamDecoder, StreamProtocol, recognize_protocol
from .receiver import Receiver, allowed_networks
from .senders import Packets, encode_recording, joints_of

__all__ = [
    "MAX_PEOPLE",
    "PORT",
    "ListenerState",
    "LiveFrame",
    "Packets",
    "PoseFrame",
    "Receiver",
    "StreamCounts",
    "StreamDecoder",
    "StreamFrame",
    "StreamListener",
    "StreamProtocol",
    "StreamReader",
    "allowed_networks",
    "encode_frame",
    "encode_recording",
    "frames_from_recording",
    "joints_from_pose",
    "joints_of",
    "measured_rate",
    "motion_from_poses",
    "recognize_protocol",
    "recording_from_frames",
]
