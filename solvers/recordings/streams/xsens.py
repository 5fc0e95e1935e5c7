"""The network stream of Xsens MVN [1]_: big-endian datagrams of segments in the world.

Read is the pose with quaternions (type 02, Z up). Datagrams of other types are left out: an
MVN that streams several types is read by this one.

References
----------
.. [1] Xsens, MVN real-time network streaming protocol specification, sections 2.4 and 2.5.
"""

import struct
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...errors import InvalidMotionError
from ..conventions import CENTIMETER, guess_unit
from ..live import PoseFrame
from .axes import checked_positions, checked_rotations
from .segments import SegmentPoses

MAGIC = b"MXTP"
POSE = b"MXTP02"
HEADER = struct.Struct(">6sIBBIBBBBHH")
"""Type, sample, datagram, number of items, time in ms, character, numbers of segments, props
and fingers, reserved, size of the rest."""
SEGMENT = np.dtype([("id", ">i4"), ("position", ">f4", 3), ("rotation", ">f4", 4)])
LAST_DATAGRAM = 0x80
"""Bit of the datagram's number that marks the last one of a sample."""
SIDE = ("Shoulder", "UpperArm", "ForeArm", "Hand")
LEG = ("UpperLeg", "LowerLeg", "Foot", "Toe")
NAMES = (
    "Pelvis", "L5", "L3", "T12", "T8", "Neck", "Head",
    *(f"{side}{part}" for chain in (SIDE, LEG) for side in ("Right", "Left") for part in chain),
)  # fmt: skip
"""The segments by their number."""
PARENTS = (-1, 0, 1, 2, 3, 4, 5, 4, 7, 8, 9, 4, 11, 12, 13, 0, 15, 16, 17, 0, 19, 20, 21)
N_SEGMENTS = len(NAMES)
MILLISECOND = 1e-3
DAMAGED = "A datagram of Xsens MVN is damaged."
OTHER_TYPE = (
    "Xsens MVN sends no poses with quaternions. In its Network Streamer switch on the position"
    " and orientation with quaternions (type 02)."
)


class _Header(NamedTuple):
    """What the first bytes say."""

    kind: bytes
    sample: int
    datagram: int
    n_items: int
    milliseconds: int
    character: int


class XsensDecoder:
    """Gathers the segments of samples; invalid datagrams change nothing."""

    max_parts = 256
    """Number of datagrams to read at a time: a second at 240 Hz."""

    def __init__(self) -> None:
        self._sample: tuple[int, int] | None = None
        self._segments: list[NDArray[np.void]] = []
        self._poses = SegmentPoses()
        self._unit: float | None = None

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""
        return [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield the frame that a datagram completes.

        Raises
        ------
        InvalidMotionError
            The datagram is damaged, of another type, or has an invalid value.
        """
        if len(part) < HEADER.size:
            raise InvalidMotionError(DAMAGED)
        header = _Header(*HEADER.unpack_from(part)[:6])
        if header.kind != POSE:
            raise InvalidMotionError(OTHER_TYPE)
        content = part[HEADER.size :]
        if header.n_items * SEGMENT.itemsize != len(content):
            raise InvalidMotionError(DAMAGED)
        key = (header.character, header.sample)
        if key != self._sample:
            self._sample, self._segments = key, []
        self._segments.append(np.frombuffer(content, SEGMENT))
        if header.datagram & LAST_DATAGRAM:
            segments = np.concatenate(self._segments)
            self._sample, self._segments = None, []
            yield self._frame(header, segments)
        elif len(self._segments) > N_SEGMENTS:
            self._sample, self._segments = None, []
            raise InvalidMotionError(DAMAGED)

    def _frame(self, header: _Header, segments: NDArray[np.void]) -> PoseFrame:
        """Return the frame of a sample; props and fingers come after the body."""
        body = segments[:N_SEGMENTS]
        if body["id"].tolist() != list(range(1, N_SEGMENTS + 1)):
            raise InvalidMotionError(DAMAGED)
        rotations = checked_rotations(body["rotation"].astype(np.float64))
        raw = body["position"].astype(np.float64)
        checked_positions(CENTIMETER * raw)
        if self._unit is None:
            self._unit = guess_unit(PARENTS, raw - raw[list(PARENTS)])
        return self._poses.frame(
            MILLISECOND * header.milliseconds,
            header.character,
            NAMES,
            PARENTS,
            _forward(self._unit * raw),
            _turned(rotations),
        )


def is_xsens(packet: bytes) -> bool:
    """Return whether a packet is of this protocol."""
    return packet.startswith(MAGIC)


def encode_xsens(frame: PoseFrame, positions: Array, rotations: Array) -> bytes:
    """Return the datagram of a frame, from its world positions and rotations.

    Parameters
    ----------
    frame : PoseFrame
        Its joints are the 23 segments. Its time counts the samples too.
    positions : shape (23, 3), meters
    rotations : shape (23, 4)
    """
    segments = np.zeros(N_SEGMENTS, SEGMENT)
    segments["id"] = np.arange(1, N_SEGMENTS + 1)
    segments["position"] = _unforward(positions) / CENTIMETER
    segments["rotation"] = _unturned(rotations)
    content, milliseconds = segments.tobytes(), round(frame.time / MILLISECOND)
    return HEADER.pack(
        POSE, milliseconds, LAST_DATAGRAM, N_SEGMENTS, milliseconds, frame.body,
        N_SEGMENTS, 0, 0, 0, len(content),
    ) + content  # fmt: skip


def _forward(points: Array) -> Array:
    """Convert MVN's axes, X forward and Y to the left, to ours."""
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([y, -x, z], axis=-1)


def _unforward(points: Array) -> Array:
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([-y, x, z], axis=-1)


def _turned(rotations: Array) -> Array:
    return np.concatenate([rotations[..., :1], _forward(rotations[..., 1:])], axis=-1)


def _unturned(rotations: Array) -> Array:
    return np.concatenate([rotations[..., :1], _unforward(rotations[..., 1:])], axis=-1)
