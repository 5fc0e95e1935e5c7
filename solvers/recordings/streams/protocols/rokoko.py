"""The JSON of Rokoko Studio, versions 2 and 3, plain or compressed with LZ4.

Bones have positions and rotations in the world, in Unity's axes. Their rotations in the T-pose
are not zero (`T_POSE`).
"""

import json
from collections.abc import Iterator, Mapping
from typing import Any, NoReturn

import numpy as np

from ....arrays import Array
from ....errors import InvalidMotionError
from ....json_text import parse_json
from ....motion.humanoid import SIDES
from ....rotations import inverse, multiply
from ...conventions import MAX_TIME_S
from ..frames import PoseFrame
from .axes import (
    checked_positions,
    checked_rotations,
    points_from_unity,
    points_to_unity,
    rotations_from_unity,
    rotations_to_unity,
)
from .humanoid import PARENTS, parent_indices
from .lz4 import MAGIC as LZ4_MAGIC
from .lz4 import MAX_OUTPUT_BYTES, decompress
from .segments import SegmentPoses

MAX_ACTORS = 8
"""Maximum number of actors; Studio streams five. It bounds the time of a packet."""
MAX_LISTS = 4096
"""Maximum number of lists and objects in a packet; five actors with fingers take 900. It bounds
the time of a packet."""
MAX_POLL_BYTES = 1 << 20
"""Maximum number of decompressed bytes that arrive together: ten frames of five actors. It
bounds the time of floods."""
HALF = float(np.sqrt(0.5))
TRUNK = {"hip": "hips", "spine": "spine", "chest": "chest", "neck": "neck", "head": "head"}
LIMBS = {
    "Shoulder": "Shoulder", "UpperArm": "UpperArm", "LowerArm": "LowerArm", "Hand": "Hand",
    "UpLeg": "UpperLeg", "Leg": "LowerLeg", "Foot": "Foot", "Toe": "Toes",
    **{f"{finger}{part}": f"{finger}{role}"
       for finger in ("Index", "Middle", "Ring", "Little")
       for part, role in (("Proximal", "Proximal"), ("Medial", "Intermediate"),
                          ("Distal", "Distal"))},
    "ThumbProximal": "ThumbMetacarpal", "ThumbMedial": "ThumbProximal",
    "ThumbDistal": "ThumbDistal",
}  # fmt: skip
ROLES = TRUNK | {
    f"{side}{bone}": f"{side}{role}"
    for side in SIDES for bone, role in LIMBS.items()
}  # fmt: skip
"""Humanoid roles of the bones."""
BONES = {role: bone for bone, role in ROLES.items()}


def _t_pose(role: str) -> tuple[float, float, float, float]:
    """Return the rotation of a bone in the T-pose, w x y z in Unity's axes."""
    if role == "hips":
        return (1.0, 0.0, 0.0, 0.0)
    if role in TRUNK.values():
        return (0.0, 0.0, 0.0, 1.0)
    side = 1.0 if role.startswith("left") else -1.0
    if role.endswith("Shoulder"):
        return (-side * HALF, 0.0, 0.0, HALF)
    if role.endswith("Leg"):
        return (HALF, 0.0, side * HALF, 0.0)
    if role.endswith(("Foot", "Toes")):
        return (0.0, 0.0, side * HALF, -side * HALF)
    if role.endswith("ThumbMetacarpal"):
        return (-side * 0.0923, -side * 0.56098, -0.70106, 0.43046)
    if "Thumb" in role:
        return (-side * 0.2706, -side * 0.65328, -0.65328, 0.2706)
    return (-side * 0.5, -side * 0.5, -0.5, 0.5)


T_POSE = {role: _t_pose(role) for role in BONES}
"""Rotations of the bones of Studio's actor in the T-pose, as Rokoko's plugins have them."""


def is_rokoko(packet: bytes) -> bool:
    """Return whether a packet is of this protocol."""
    return packet.startswith(LZ4_MAGIC) or b'"actors"' in packet


class RokokoDecoder:
    """Decodes frames of one or several actors."""

    max_parts = 64
    """Number of packets to read at a time: a second at 60 Hz."""

    def __init__(self) -> None:
        self._actors: dict[str, tuple[int, SegmentPoses]] = {}
        self._arrived = float("nan")
        self._n_bytes = 0

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""
        return [datagram]

    def decode(self, part: bytes, arrived: float) -> Iterator[PoseFrame]:
        """Yield a frame of each actor.

        Raises
        ------
        InvalidMotionError
            The packet is damaged, or has an invalid value.
        """
        text = self._decompressed(part, arrived) if part.startswith(LZ4_MAGIC) else part
        if text.count(b"[") + text.count(b"{") > MAX_LISTS:
            raise InvalidMotionError(f"A frame has more than {MAX_LISTS} lists.")
        try:
            fields = parse_json(text, parse_constant=_refuse)
        except ValueError:
            raise InvalidMotionError("A packet of Rokoko is not readable as JSON.") from None
        scene = _mapping(_mapping(fields).get("scene", fields))
        actors = scene.get("actors")
        if not isinstance(actors, list) or len(actors) > MAX_ACTORS:
            raise InvalidMotionError(f"A packet of Rokoko lacks up to {MAX_ACTORS} actors.")
        time = _number(scene.get("timestamp", arrived))
        if not abs(time) <= MAX_TIME_S:
            raise InvalidMotionError(f"A frame's time is not a number up to {MAX_TIME_S:g}.")
        for actor in actors:
            yield self._frame(_mapping(actor), time)

    def _decompressed(self, part: bytes, arrived: float) -> bytes:
        """Return the content of a packet, unless those of its poll are too large."""
        if arrived != self._arrived:
            self._arrived, self._n_bytes = arrived, 0
        if self._n_bytes > MAX_POLL_BYTES:
            raise InvalidMotionError("More compressed packets came at once than are read.")
        self._n_bytes += MAX_OUTPUT_BYTES
        text = decompress(part)
        self._n_bytes += len(text) - MAX_OUTPUT_BYTES
        return text

    def _frame(self, actor: Mapping[str, Any], time: float) -> PoseFrame:
        name = str(actor.get("name", ""))
        if name not in self._actors and len(self._actors) >= MAX_ACTORS:
            self._actors.clear()
        body, poses = self._actors.setdefault(name, (len(self._actors), SegmentPoses()))
        bones = _mapping(actor.get("body", actor))
        sent = {ROLES[bone] for bone in ROLES if isinstance(bones.get(bone), Mapping)}
        roles = [role for role in PARENTS if role in sent]
        if roles[:1] != ["hips"]:
            raise InvalidMotionError("An actor of Rokoko has no hip.")
        positions = _vectors(bones, roles, "position", "xyz")
        rotated = checked_rotations(_vectors(bones, roles, "rotation", "wxyz"))
        rest = np.array([T_POSE[role] for role in roles])
        return poses.frame(
            time,
            body,
            roles,
            parent_indices(roles),
            points_from_unity(checked_positions(positions)),
            rotations_from_unity(multiply(rotated, inverse(rest))),
        )


def encode_rokoko(frame: PoseFrame, positions: Array, rotations: Array) -> bytes:
    """Return version 3 of the JSON, from (n, 3) world positions and (n, 4) rotations."""
    rest = np.array([T_POSE[role] for role in frame.names])
    rotated = multiply(rotations_to_unity(rotations), rest).round(6)
    points = points_to_unity(positions).round(5)
    body = {
        BONES[role]: {
            "position": dict(zip("xyz", point, strict=True)),
            "rotation": dict(zip("wxyz", rotation, strict=True)),
        }
        for role, point, rotation in zip(
            frame.names, points.tolist(), rotated.tolist(), strict=True
        )
    }
    actor = {"name": f"actor {frame.body}", "body": body}
    scene = {"timestamp": round(frame.time, 6), "actors": [actor], "props": []}
    fields = {"version": "3,0", "fps": 60, "scene": scene}
    return json.dumps(fields, separators=(",", ":"), allow_nan=False).encode()


def _vectors(bones: Mapping[str, Any], roles: list[str], name: str, axes: str) -> Array:
    """Return a vector of each bone, shape (n_bones, n_axes)."""
    vectors = [_mapping(bones[BONES[role]].get(name)) for role in roles]
    return np.array([[_number(vector.get(axis)) for axis in axes] for vector in vectors])


def _mapping(value: Any) -> Mapping[str, Any]:
    if not isinstance(value, Mapping):
        raise InvalidMotionError("A packet of Rokoko lacks an object.")
    return value


def _number(value: Any) -> float:
    if type(value) not in (int, float) or not abs(value) < 1e300:
        raise InvalidMotionError("A packet of Rokoko lacks a number.")
    return float(value)


def _refuse(word: str) -> NoReturn:
    """Refuse NaN and Infinity, which are not JSON."""
    raise ValueError(word)
