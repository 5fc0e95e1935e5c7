"""The stream of Sony mocopi: boxes of a length, a name of four letters, and a content.

A packet holds a skeleton (`skdf`) or a frame (`fram`) of bones, each with its parent, rotation
and position. Frames hold the positions of all bones too, and mocopi's bones are always the
same, so that frames are read before a skeleton has come.
"""

import struct
from collections.abc import Iterator

import numpy as np

from ....arrays import Array
from ....errors import InvalidMotionError
from ....motion import Skeleton
from ...conventions import (
    MAX_TIME_S,
    rotations_y_up_from_z_up,
    rotations_z_up_from_y_up,
    y_up_from_z_up,
    z_up_from_y_up,
)
from ..frames import PoseFrame
from .axes import checked_positions, checked_rotations
from .humanoid import standing

PORT = 12351
HEAD = b"head"
FORMAT = b"sony motion format"
PREFIX = struct.Struct("<I4s")
TRANSFORM = struct.Struct("<7f")
"""Quaternion x y z w, and position in meters."""
NO_PARENT = 0xFFFF
MAX_BONES = 64
"""Maximum number of bones; mocopi has 27. It bounds the time of a packet."""
MAX_BOXES = 16
"""Maximum number of boxes in another one, bones aside; mocopi has up to 4. It bounds the time
of a packet."""
MAX_CHANGE_M = 0.01
"""Change of a bone in meters from which the body is another one. It guards against rounding."""
ARM, LEG = ("shoulder", "up_arm", "low_arm", "hand"), ("up_leg", "low_leg", "foot", "toes")
NAMES = (
    "root", *(f"torso_{number}" for number in range(1, 8)), "neck_1", "neck_2", "head",
    *(f"{side}_{part}" for chain in (ARM, LEG) for side in "lr" for part in chain),
)  # fmt: skip
"""Names of the bones in mocopi's BVH files, by number."""
PARENTS = (
    -1, *range(10),
    7, 11, 12, 13, 7, 15, 16, 17, 0, 19, 20, 21, 0, 23, 24, 25,
)  # fmt: skip
DAMAGED = "A packet of mocopi is damaged."


def is_mocopi(packet: bytes) -> bool:
    """Return whether a packet is of this protocol."""
    return packet[4:8] == HEAD and FORMAT in packet[: 4 * PREFIX.size + len(FORMAT)]


class MocopiDecoder:
    """Decodes frames; invalid packets change nothing."""

    max_parts = 128
    """Number of packets to read at a time: two seconds."""

    def __init__(self) -> None:
        self._parents: tuple[int, ...] = PARENTS
        self._skeleton: Skeleton | None = None

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""
        return [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield the frame of a packet, if it is one.

        Raises
        ------
        InvalidMotionError
            The packet is damaged, or has an invalid value.
        """
        try:
            packet = dict(_boxes(part, MAX_BOXES))
            if skeleton := packet.get(b"skdf"):
                self._parents = _parents(skeleton)
            elif frame := packet.get(b"fram"):
                yield self._frame(dict(_boxes(frame, MAX_BOXES)))
        except (struct.error, KeyError, ValueError):
            raise InvalidMotionError(DAMAGED) from None

    def _frame(self, boxes: dict[bytes, bytes]) -> PoseFrame:
        bones = [dict(_boxes(bone, MAX_BOXES)) for _, bone in _boxes(boxes[b"btrs"], MAX_BONES)]
        numbers = [int.from_bytes(bone[b"bnid"], "little") for bone in bones]
        if numbers != list(range(len(self._parents))):
            raise InvalidMotionError("A frame of mocopi lacks bones of the skeleton.")
        values = np.array([TRANSFORM.unpack(bone[b"tran"]) for bone in bones])
        positions = z_up_from_y_up(checked_positions(values[:, 4:]))
        rotations = rotations_z_up_from_y_up(checked_rotations(values[:, [3, 0, 1, 2]]))
        time = _time(boxes)
        return PoseFrame(time, 0, self._skeleton_of(positions), rotations, positions[0])

    def _skeleton_of(self, offsets: Array) -> Skeleton:
        last = self._skeleton
        if (
            last is None
            or last.parents != self._parents
            or np.abs(last.offsets[1:] - offsets[1:]).max() > MAX_CHANGE_M
        ):
            self._skeleton = last = standing(_names(len(offsets)), self._parents, offsets)
        return last


def _boxes(content: bytes, max_number: int) -> Iterator[tuple[bytes, bytes]]:
    offset = 0
    for _ in range(max_number):
        if offset == len(content):
            return
        length, name = PREFIX.unpack_from(content, offset)
        offset += PREFIX.size + length
        if offset > len(content):
            raise ValueError("length")
        yield name, content[offset - length : offset]
    if offset < len(content):
        raise ValueError("number")


def _parents(skeleton: bytes) -> tuple[int, ...]:
    """Return the parents of the bones of a skeleton, -1 for the root."""
    parents = []
    for _, bone in _boxes(dict(_boxes(skeleton, MAX_BOXES))[b"bons"], MAX_BONES):
        boxes = dict(_boxes(bone, MAX_BOXES))
        number = int.from_bytes(boxes[b"bnid"], "little")
        parent = int.from_bytes(boxes[b"pbid"], "little")
        parents.append(-1 if parent == NO_PARENT else parent)
        is_root = number == 0 and parents[0] == -1
        if number != len(parents) - 1 or not (is_root or 0 <= parents[-1] < number):
            raise ValueError("order")
    if not parents:
        raise ValueError("empty")
    return tuple(parents)


def _names(n_bones: int) -> tuple[str, ...]:
    return (*NAMES[:n_bones], *(f"bone_{number}" for number in range(len(NAMES), n_bones)))


def _time(boxes: dict[bytes, bytes]) -> float:
    """Return the time of the clock, or that since the app's start, seconds."""
    if (clock := boxes.get(b"uttm")) is not None:
        (time,) = struct.unpack("<d", clock)
    else:
        (time,) = struct.unpack("<f", boxes[b"time"])
    if not abs(time) <= MAX_TIME_S:
        raise ValueError("time")
    return float(time)


def encode_skeleton_packet(skeleton: Skeleton) -> bytes:
    """Return the packet of a skeleton, which mocopi sends before the frames."""
    bones = b""
    for number, (parent, offset) in enumerate(
        zip(skeleton.parents, y_up_from_z_up(skeleton.offsets), strict=True)
    ):
        above = NO_PARENT if parent < 0 else parent
        transform = TRANSFORM.pack(0.0, 0.0, 0.0, 1.0, *offset)
        bones += _box(b"bndt", _number_box(b"bnid", number) + _number_box(b"pbid", above)
                      + _box(b"tran", transform))  # fmt: skip
    return _heading() + _box(b"skdf", _box(b"bons", bones))


def encode_frame_packet(frame: PoseFrame, number: int) -> bytes:
    """Return the packet of a frame, whose skeleton has the bones of mocopi."""
    positions = y_up_from_z_up(np.array([frame.root_position, *frame.skeleton.offsets[1:]]))
    rotations = rotations_y_up_from_z_up(frame.rotations)
    bones = b""
    for bone, (position, (w, x, y, z)) in enumerate(zip(positions, rotations, strict=True)):
        transform = TRANSFORM.pack(x, y, z, w, *position)
        bones += _box(b"btdt", _number_box(b"bnid", bone) + _box(b"tran", transform))
    times = _box(b"fnum", struct.pack("<I", number))
    times += _box(b"time", struct.pack("<f", frame.time))
    clock = _box(b"uttm", struct.pack("<d", frame.time))
    return _heading() + _box(b"fram", times + clock + _box(b"btrs", bones))


def _heading() -> bytes:
    head = _box(b"ftyp", FORMAT) + _box(b"vrsn", b"\x01")
    sender = _box(b"ipad", bytes(8)) + _number_box(b"rcvp", PORT)
    return _box(HEAD, head) + _box(b"sndf", sender)


def _box(name: bytes, content: bytes) -> bytes:
    return PREFIX.pack(len(content), name) + content


def _number_box(name: bytes, number: int) -> bytes:
    return _box(name, struct.pack("<H", number))
