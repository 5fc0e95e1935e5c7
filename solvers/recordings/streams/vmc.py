"""The protocol of Virtual Motion Capture (VMC) [1]_: bones of Unity's humanoid over OSC.

A frame comes in one packet or in many. It is complete as soon as all bones have come that came
in the last frames, or when one comes again.

References
----------
.. [1] protocol.vmc.info, specification of performer and marionette.
"""

from collections.abc import Iterator

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Skeleton
from ...rotations import multiply, rotate
from ..conventions import MAX_TIME_S
from ..live import PoseFrame
from .axes import (
    MAX_POSITION_M,
    checked_rotations,
    points_from_unity,
    points_to_unity,
    rotations_from_unity,
    rotations_to_unity,
)
from .humanoid import PARENTS, skeleton_from_offsets, sorted_roles
from .osc import BUNDLE, Message, read_packet, write_bundle, write_message

TIME, ROOT, BONE = "/VMC/Ext/T", "/VMC/Ext/Root/Pos", "/VMC/Ext/Bone/Pos"
AVAILABLE = "/VMC/Ext/OK"
N_NUMBERS = 7
"""Position x y z and quaternion x y z w."""
STILL = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
MAX_MISSED_FRAMES = 10
"""Number of frames after which a bone that no longer comes is not waited for. Chosen by hand:
lost packets cost one bone of a frame or two."""
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


class VmcDecoder:
    """Gathers the bones of frames; invalid packets change nothing."""

    max_parts = 192
    """Number of packets to read at a time: three frames of a sender with a packet per bone."""

    def __init__(self) -> None:
        self._root: tuple[float, ...] = STILL
        self._bones: dict[str, tuple[float, ...]] = {}
        self._seen: dict[str, int] = {}
        self._fresh: set[str] = set()
        self._n_frames = 0
        self._clock: tuple[float, float] | None = None
        self._frame_time = 0.0
        self._frame_root: tuple[float, ...] = STILL
        self._skeleton: Skeleton | None = None
        self._offsets = np.zeros((0, 3))

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""
        return [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield the frames that a packet completes.

        Raises
        ------
        InvalidMotionError
            The packet is damaged, or has an invalid value.
        """
        for message in read_packet(part):
            if message.address == TIME and message.arguments:
                self._clock = (_numbers(message.arguments[:1], MAX_TIME_S)[0], arrived)
            elif message.address == ROOT:
                self._root = _transform(message)[1]
            elif message.address == BONE:
                yield from self._add_bone(*_transform(message), arrived)
        expected = {role for role in self._seen if not self._is_gone(role)}
        if expected and self._fresh >= expected:
            self._frame_root = self._root
            yield self._frame()

    def _add_bone(
        self, name: str, numbers: tuple[float, ...], arrived: float
    ) -> Iterator[PoseFrame]:
        """Add a bone to the frame; yield the frame before if this one begins another."""
        role = ROLES.get(name.lower())
        if role is None:
            return
        if role in self._fresh:
            yield self._frame()
        if not self._fresh:
            self._frame_time = self._time(arrived)
        self._bones[role], self._frame_root = numbers, self._root
        self._fresh.add(role)

    def _is_gone(self, role: str) -> bool:
        return self._n_frames - self._seen[role] > MAX_MISSED_FRAMES

    def _frame(self) -> PoseFrame:
        """Return the frame of the bones that came last."""
        self._n_frames += 1
        self._seen |= dict.fromkeys(self._fresh, self._n_frames)
        self._fresh.clear()
        for role in [role for role in self._seen if self._is_gone(role)]:
            del self._seen[role], self._bones[role]
        if "hips" not in self._bones:
            raise InvalidMotionError("A frame has no hips.")
        roles = sorted_roles(self._bones)
        numbers = np.array([self._frame_root, *(self._bones[role] for role in roles)])
        positions = points_from_unity(numbers[:, :3])
        rotations = rotations_from_unity(checked_rotations(numbers[:, [6, 3, 4, 5]]))
        root_position = positions[0] + rotate(rotations[0], positions[1])
        rotations[1] = multiply(rotations[0], rotations[1])
        skeleton = self._skeleton_of(roles, positions[1:])
        return PoseFrame(self._frame_time, 0, skeleton, rotations[1:], root_position)

    def _time(self, arrived: float) -> float:
        """Return the sender's time, which need not come with every frame."""
        if self._clock is None:
            return arrived
        time, at = self._clock
        return time + max(arrived - at, 0.0)

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


def _transform(message: Message) -> tuple[str, tuple[float, ...]]:
    """Return the name of a message, and its position and rotation."""
    name, *numbers = message.arguments or (None,)
    if not isinstance(name, str) or len(numbers) < N_NUMBERS:
        raise InvalidMotionError("A bone has no name, position and rotation.")
    return name, _numbers(tuple(numbers[:N_NUMBERS]), MAX_POSITION_M)


def _numbers(values: tuple[object, ...], limit: float) -> tuple[float, ...]:
    if not all(isinstance(value, float) and abs(value) <= limit for value in values):
        raise InvalidMotionError(f"A frame's number is not one up to {limit:g}.")
    return tuple(float(value) for value in values if isinstance(value, float))


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
        write_message(ROOT, "root", *STILL),
    ]
    chunks = [
        bones[start : start + BONES_PER_PACKET]
        for start in range(0, len(bones), BONES_PER_PACKET)
    ]
    return [write_bundle(head + chunks[0]), *map(write_bundle, chunks[1:])]
