"""Receive a live stream of joints over the local network."""

from .frames import MAX_JOINTS, PORT, LiveFrame, encode_frame, frames_from_recording
from .receiver import Receiver
from .stream import StreamCounts, StreamReader, recording_from_frames

__all__ = [
    "MAX_JOINTS",
    "PORT",
    "LiveFrame",
    "Receiver",
    "StreamCounts",
    "StreamReader",
    "encode_frame",
    "frames_from_recording",
    "recording_from_frames",
]
