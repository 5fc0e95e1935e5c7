"""Joints that arrive over the local network while they are recorded."""

from .frames import MOST_JOINTS, PORT, LiveFrame, encode_frame, frames_of
from .receiver import Receiver
from .stream import Heard, StreamReader, recording_of

__all__ = [
    "MOST_JOINTS",
    "PORT",
    "Heard",
    "LiveFrame",
    "Receiver",
    "StreamReader",
    "encode_frame",
    "frames_of",
    "recording_of",
]
