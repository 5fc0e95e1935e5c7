"""The protocol of Virtual Motion Capture (VMC) [1]_: bones of Unity's humanoid over OSC.

A frame comes in one packet or in many. It is complete as soon as all bones have come that came
in the last frames, or when one comes again.

References
----------
.. [1] protocol.vmc.info, specification of performer and marionette.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ....arrays import Array
from ....errors import InvalidMotionError
from ....motion import Skeleton
from ....rotations import multiply, normalize, rotate
from ...conventions import MAX_TIME_S
from ..frames import PoseFrame
from .axes import (
    MAX_POSITION_M,
    is_rotation,
    points_from_unity,
    points_to_unity,
    rotations_from_unity,
    rotations_to_unity,
)
from .humanoid import PARENTS, skeleton_from_offsets, sorted_roles
from .osc import BUNDLE, Argument, Message, read_packet, write_bundle, write_message

TIME, ROOT, BONE = "/VMC/Ext/T", "/VMC/Ext/Root/Pos", "/VMC/Ext/Bone/Pos"
READ_ADDRESSES = tuple(address.encode() for address in (TIME, ROOT, BONE))
AVAILABLE = "/VMC/Ext/OK"
N_NUMBERS = 7
"""Position x y z and quaternion x y z w."""
ROOT_AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
MAX_MISSED_FRAMES = 10
"""Number of frames after which a bone that no longer comes is not waited for. Chosen by hand:
lost packets cost one bone of a frame or two."""
MAX_STILL_FRAMES = 3
"""Number of frames with the same time after which the clock is left out. It guards against
seconds since 1970 as 32-bit numbers, which stand still for two minutes."""
MAX_CHANGE_M = 0.01
"""Change of a bone in meters from which the body is another one. It guards against rounding and
stretched bones."""
BONES_PER_PACKET = 12
"""Number of bones in a written packet, which then fits into the 1,500 bytes of a network."""
THUMBS = {"Metacarpal": "Proximal", "Proximal": "Intermediate", "Distal": "Distal"}
"""Unity's names of the bones of a thumb."""


def _unity_name(role: str) -> str:
    stem, _, part = role.partition("Thumb")
    name = f"{stem}Thumb{THUMBS[part]}" if part else role
    return name[0].upper() + name[1:]


NAMES = {role: _unity_name(role) for role in PARENTS}
ROLES = {name.lower(): role for role, name in NAMES.items()}


def is_vmc(packet: bytes) -> bool:
    """Return whether a packet is of this protocol."""
    return packet.startswith((BUNDLE, b"/VMC/"))


class _Clock(NamedTuple):
    """A time of the sender."""

    time: float
    arrived: float
    n_frames: int
    """Number of frames before it came."""


class _Packet(NamedTuple):
    """What a packet says."""

    time: float | None
    root: tuple[float, ...] | None
    bones: dict[str, tuple[float, ...]]
    """By role."""


class VmcDecoder:
    """Gathers the bones of frames; invalid packets change nothing."""

    max_parts = 192
    """Number of packets to read at a time: three frames of a sender with a packet per bone."""

    def __init__(self) -> None:
        self._root: tuple[float, ...] = ROOT_AT_ORIGIN
        self._bones: dict[str, tuple[float, ...]] = {}
        self._last_frames: dict[str, int] = {}
        self._fresh: set[str] = set()
        self._n_frames = 0
        self._clock: _Clock | None = None
        self._has_new_time = False
        self._stands_still = False
        self._frame_time = 0.0
        self._frame_root: tuple[float, ...] = ROOT_AT_ORIGIN
        self._skeleton: Skeleton | None = None
        self._offsets = np.zeros((0, 3))

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself; none of expressions, cameras and trackers."""
        is_other = datagram.startswith((BUNDLE, b"/")) and not any(
            address in datagram for address in READ_ADDRESSES
        )
        return [] if is_other else [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield the frames that a packet completes.

        Raises
        ------
        InvalidMotionError
            The packet is damaged, or has an invalid value or a bone twice.
        """
        packet = _read(part)
        if packet.time is not None:
            self._set_clock(packet.time, arrived)
        if packet.root is not None:
            self._root = packet.root
        if not self._fresh.isdisjoint(packet.bones):
            yield self._frame()
        if packet.bones and not self._fresh:
            self._frame_time = self._time(arrived)
        if packet.bones:
            self._bones |= packet.bones
            self._fresh |= packet.bones.keys()
            self._frame_root = self._root
        expected = {role for role in self._last_frames if not self._is_gone(role)}
        if expected and self._fresh >= expected:
            self._frame_root = self._root
            yield self._frame()

    def _set_clock(self, time: float, arrived: float) -> None:
        """Take a time; several packets of a frame may have the same."""
        if self._clock is None or time != self._clock.time:
            self._clock = _Clock(time, arrived, self._n_frames)
            self._has_new_time = True
        elif self._n_frames - self._clock.n_frames > MAX_STILL_FRAMES:
            self._stands_still = True

    def _is_gone(self, role: str) -> bool:
        return self._n_frames - self._last_frames[role] > MAX_MISSED_FRAMES

    def _frame(self) -> PoseFrame:
        """Return the frame of the bones that came last."""
        self._n_frames += 1
        self._last_frames |= dict.fromkeys(self._fresh, self._n_frames)
        self._fresh.clear()
        for role in [role for role in self._last_frames if self._is_gone(role)]:
            del self._last_frames[role], self._bones[role]
        if "hips" not in self._bones:
            raise InvalidMotionError("A frame has no hips.")
        roles = sorted_roles(self._bones)
        numbers = np.array([self._frame_root, *(self._bones[role] for role in roles)])
        positions = points_from_unity(numbers[:, :3])
        rotations = rotations_from_unity(normalize(numbers[:, [6, 3, 4, 5]]))
        root_position = positions[0] + rotate(rotations[0], positions[1])
        rotations[1] = multiply(rotations[0], rotations[1])
        skeleton = self._skeleton_of(roles, positions[1:])
        return PoseFrame(self._frame_time, 0, skeleton, rotations[1:], root_position)

    def _time(self, arrived: float) -> float:
        """Return the sender's time for a frame that begins.

        Most senders end a frame with its time; that of the frame before is then used for each.
        A time need not come with every frame.
        """
        clock, has_new_time = self._clock, self._has_new_time
        self._has_new_time = False
        if clock is None or self._stands_still:
            return arrived
        return clock.time if has_new_time else clock.time + max(arrived - clock.arrived, 0.0)

    def _skeleton_of(self, roles: tuple[str, ...], offsets: Array) -> Skeleton:
        """Return the skeleton of bones; a new one if they are others, or of other lengths."""
        last = self._skeleton
        if (
            last is None
            or last.names != roles
            or np.abs(self._offsets[1:] - offsets[1:]).max(initial=0.0) > MAX_CHANGE_M
        ):
            self._offsets = offsets
            last = skeleton_from_offsets(dict(zip(roles, offsets, strict=True)))
            self._skeleton = last
        return last


def _read(part: bytes) -> _Packet:
    """Return what a packet says; rotations that are none are left out."""
    time: float | None = None
    root: tuple[float, ...] | None = None
    bones: dict[str, tuple[float, ...]] = {}
    for message in read_packet(part):
        if message.address == TIME and message.arguments:
            (time,) = _numbers(message.arguments[:1], MAX_TIME_S)
        elif message.address in {ROOT, BONE}:
            name, numbers = _transform(message)
            if not is_rotation(numbers[3:]):
                continue
            if message.address == ROOT:
                root = numbers
            elif role := ROLES.get(name.lower()):
                if role in bones:
                    raise InvalidMotionError("A packet has a bone twice.")
                bones[role] = numbers
    return _Packet(time, root, bones)


def _transform(message: Message) -> tuple[str, tuple[float, ...]]:
    """Return the name of a message, and its position and rotation."""
    name, *numbers = message.arguments or (None,)
    if not isinstance(name, str) or len(numbers) < N_NUMBERS:
        raise InvalidMotionError("A bone has no name, position and rotation.")
    return name, _numbers(tuple(numbers[:N_NUMBERS]), MAX_POSITION_M)


def _numbers(values: tuple[Argument, ...], limit: float) -> tuple[float, ...]:
    numbers = [
        float(value)
        for value in values
        if isinstance(value, int | float)
        and not isinstance(value, bool)
        and abs(value) <= limit
    ]
    if len(numbers) < len(values):
        raise InvalidMotionError(f"A frame's number is not one up to {limit:g}.")
    return tuple(numbers)


def encode_vmc(frame: PoseFrame) -> list[bytes]:
    """Return the packets of a frame, whose joints are named by humanoid roles."""
    positions = points_to_unity(np.array([frame.root_position, *frame.skeleton.offsets[1:]]))
    rotations = rotations_to_unity(frame.rotations)
    numbers = np.concatenate([positions, rotations[:, 1:], rotations[:, :1]], axis=1)
    bones = [
        write_message(BONE, NAMES[name], *map(float, row))
        for name, row in zip(frame.names, numbers, strict=True)
    ]
    head = [
        write_message(AVAILABLE, 1),
        write_message(TIME, float(frame.time)),
        write_message(ROOT, "root", *ROOT_AT_ORIGIN),
    ]
    chunks = [
        bones[start : start + BONES_PER_PACKET]
        for start in range(0, len(bones), BONES_PER_PACKET)
    ]
    return [write_bundle(head + chunks[0]), *map(write_bundle, chunks[1:])]
