"""Streams of other programs: VMC, mocopi, Xsens, Rokoko, MediaPipe, and our own JSON.

>>> from solvers.recordings.streams import StreamProtocol, recognize_protocol
>>> recognize_protocol(b"/VMC/Ext/T") is StreamProtocol.VMC
True
"""

from .listener import ListenerState, StreamListener
from .protocols import StreamDecoder, StreamProtocol, recognize_protocol
from .senders import Packets, encode_recording, joints_of

__all__ = [
    "ListenerState",
    "Packets",
    "StreamDecoder",
    "StreamListener",
    "StreamProtocol",
    "encode_recording",
    "joints_of",
    "recognize_protocol",
]
