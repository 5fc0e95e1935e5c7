"""Protocols of trackers: one file each, the decoder and the encoder of its packets."""

from .layouts import MOCOPI, XSENS, StreamLayout, humanoid_layout, motion_in_layout
from .mediapipe import encode_mediapipe
from .mocopi import encode_frame_packet, encode_skeleton_packet
from .recognition import StreamDecoder, StreamProtocol, recognize_protocol
from .rokoko import encode_rokoko
from .vmc import encode_vmc
from .xsens import encode_xsens

__all__ = [
    "MOCOPI",
    "XSENS",
    "StreamDecoder",
    "StreamLayout",
    "StreamProtocol",
    "encode_frame_packet",
    "encode_mediapipe",
    "encode_rokoko",
    "encode_skeleton_packet",
    "encode_vmc",
    "encode_xsens",
    "humanoid_layout",
    "motion_in_layout",
    "recognize_protocol",
]
