"""The network stream of Xsens MVN [1]_: big-endian datagrams of segments in the world.

The decoder reads the pose with quaternions (type 02, Z up). It ignores datagrams of other
types, so an MVN may stream several types at once.

References
----------
.. [1] Xsens, MVN real-time network streaming protocol specification, sections 2.4 and 2.5.
"""

import struct
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ....arrays import Array
from ....errors import InvalidMotionError
from ...conventions import CENTIMETER, MILLISECOND, guess_unit
from ..frames import PoseFrame
from .axes import checked_positions, checked_rotations
from .segments import SegmentPoses

MAGIC = b"MXTP"
POSE = b"MXTP02"
HEADER = struct.Struct(">6sIBBIBBBBHH")
"""Type, sample, datagram, number of items, time in ms, character, numbers of segments, props
and fingers, reserved, size of the rest."""
SEGMENT = np.dtype([("id", ">i4"), ("position", ">f4", 3), ("rotation", ">f4", 4)])
MAX_CHARACTERS = 8
"""Maximum number of characters; MVN streams four. It bounds memory."""
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


class _Character:
    """The segments of a sample that came, and the skeleton of a character."""

    def __init__(self) -> None:
        self.poses = SegmentPoses()
        self.sample = -1
        self.segments: list[NDArray[np.void]] = []

    def start(self, sample: int) -> None:
        """Forget the segments that came."""
        self.sample, self.segments = sample, []


class XsensDecoder:
    """Gathers the segments of samples; invalid datagrams change nothing."""

    max_parts = 256
    """Number of datagrams to read at a time: a second at 240 Hz."""

    def __init__(self) -> None:
        self._characters: dict[int, _Character] = {}
        self._has_poses = False
        self._unit: float | None = None

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""
        return [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield the frame that a datagram completes.

        Raises
        ------
        InvalidMotionError
            The datagram is damaged or has an invalid value, or poses do not come at all.
        """
        if len(part) < HEADER.size:
            raise InvalidMotionError(DAMAGED)
        header = _Header(*HEADER.unpack_from(part)[:6])
        if header.kind != POSE:
            if self._has_poses and header.kind.startswith(MAGIC):
                return
            raise InvalidMotionError(OTHER_TYPE)
        content = part[HEADER.size :]
        if header.n_items * SEGMENT.itemsize != len(content):
            raise InvalidMotionError(DAMAGED)
        character = self._character(header.character)
        if header.sample != character.sample:
            character.start(header.sample)
        character.segments.append(np.frombuffer(content, SEGMENT))
        if header.datagram & LAST_DATAGRAM:
            segments = np.concatenate(character.segments)
            character.start(-1)
            yield self._frame(header, segments)
        elif len(character.segments) > N_SEGMENTS:
            character.start(-1)
            raise InvalidMotionError(DAMAGED)

    def _character(self, number: int) -> _Character:
        if number not in self._characters and len(self._characters) >= MAX_CHARACTERS:
            self._characters.clear()
        return self._characters.setdefault(number, _Character())

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
        self._has_poses = True
        return self._characters[header.character].poses.frame(
            MILLISECOND * header.milliseconds,
            header.character,
            NAMES,
            PARENTS,
            _forward(self._unit * raw),
            _z_up(rotations),
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
    segments["rotation"] = _from_z_up(rotations)
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


def _z_up(rotations: Array) -> Array:
    return np.concatenate([rotations[..., :1], _forward(rotations[..., 1:])], axis=-1)


def _from_z_up(rotations: Array) -> Array:
    return np.concatenate([rotations[..., :1], _unforward(rotations[..., 1:])], axis=-1)
