"""The protocols of trackers: which one a stream has, and its decoder."""

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from ....errors import InvalidMotionError
from ....settings import Choice
from ..frames import FORMAT, FrameDecoder, JointLines, StreamFrame
from .mediapipe import MediaPipeDecoder, is_mediapipe
from .mocopi import MocopiDecoder, is_mocopi
from .rokoko import RokokoDecoder, is_rokoko
from .vmc import VmcDecoder, is_vmc
from .xsens import XsensDecoder, is_xsens


class StreamProtocol(Choice):
    """A protocol of a live stream."""

    AUTO = "auto", "Recognize the protocol from the first packets", "Automatic"
    VMC = "vmc", "Virtual Motion Capture: bones over OSC, usually port 39539", "VMC"
    MOCOPI = "mocopi", "The app of Sony mocopi, usually port 12351", "Sony mocopi"
    XSENS = "xsens", "Network Streamer of Xsens MVN, usually port 9763", "Xsens MVN"
    ROKOKO = "rokoko", "JSON of Rokoko Studio, usually port 14043", "Rokoko"
    MEDIAPIPE = "mediapipe", "World landmarks of MediaPipe, a frame in each line", "MediaPipe"
    JSON = "json", "Joints as lines of JSON, usually port 46464", "JSON"


MAX_HEAD_BYTES = 4096
"""Number of bytes in which the protocol is recognized. It bounds the time of junk."""
UNKNOWN = (
    "These packets are of no known protocol: VMC, mocopi, Xsens MVN, Rokoko, MediaPipe or JSON."
)


class _ProtocolParts(NamedTuple):
    """How a protocol is recognized and decoded."""

    recognizes: Callable[[bytes], bool]
    decoder: Callable[[], FrameDecoder]


PROTOCOLS: Mapping[StreamProtocol, _ProtocolParts] = {
    StreamProtocol.VMC: _ProtocolParts(is_vmc, VmcDecoder),
    StreamProtocol.MOCOPI: _ProtocolParts(is_mocopi, MocopiDecoder),
    StreamProtocol.XSENS: _ProtocolParts(is_xsens, XsensDecoder),
    StreamProtocol.JSON: _ProtocolParts(lambda head: FORMAT.encode() in head, JointLines),
    StreamProtocol.ROKOKO: _ProtocolParts(is_rokoko, RokokoDecoder),
    StreamProtocol.MEDIAPIPE: _ProtocolParts(is_mediapipe, MediaPipeDecoder),
}
"""In the order in which they are tried."""


def recognize_protocol(datagram: bytes) -> StreamProtocol | None:
    """Return the protocol of a datagram, or None."""
    head = datagram[:MAX_HEAD_BYTES]
    return next((each for each, entry in PROTOCOLS.items() if entry.recognizes(head)), None)


class StreamDecoder:
    """Decodes a stream of a chosen protocol, or of that of its first packet.

    Parameters
    ----------
    protocol : StreamProtocol
    """

    def __init__(self, protocol: StreamProtocol = StreamProtocol.AUTO) -> None:
        self._chosen = protocol
        self.protocol: StreamProtocol | None = None
        """The protocol of the stream; None as long as it is not recognized."""
        self._decoder: FrameDecoder = JointLines()
        self.restart()

    @property
    def max_parts(self) -> int:
        """Maximum number of parts to decode at a time."""
        return self._decoder.max_parts

    def restart(self) -> None:
        """Forget the stream: another sender comes."""
        self.protocol = None
        if self._chosen is not StreamProtocol.AUTO:
            self._use(self._chosen)

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself; recognize the protocol first."""
        if self.protocol is None:
            found = recognize_protocol(datagram)
            if found is None:
                return [datagram]
            self._use(found)
        return self._decoder.parts(datagram)

    def decode(self, part: bytes, arrived: float) -> Iterable[StreamFrame]:
        """Return the frames that a part completes.

        Raises
        ------
        InvalidMotionError
            The protocol is unknown, or the part invalid.
        """
        if self.protocol is None:
            raise InvalidMotionError(UNKNOWN)
        return self._decoder.decode(part, arrived)

    def _use(self, protocol: StreamProtocol) -> None:
        self.protocol, self._decoder = protocol, PROTOCOLS[protocol].decoder()
