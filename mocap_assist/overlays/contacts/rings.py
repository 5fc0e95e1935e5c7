"""Rings on the floor under feet, hands, knees and hips in contact, as plain arrays."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Vector
from numpy.typing import NDArray

from ....solvers.arrays import Array, Single
from ....solvers.errors import InvalidMotionError
from ...rigs.target_read import find_roles
from ...scene.played_time import played_time
from ..marked_ranges import COLORS, CONTACT_ROWS
from ..strip.reading import contacts_of

ROLES = (
    ("leftFoot", "leftToes"),
    ("rightFoot", "rightToes"),
    ("leftHand",),
    ("rightHand",),
    ("leftLowerLeg",),
    ("rightLowerLeg",),
    ("hips",),
)
"""In the order of the contact keys: the roles of the bones of each part."""
N_SEGMENTS = 16
"""Number of lines of a ring. It bounds the time of a drawing."""
RADIUS = 0.6
"""Radius of a ring relative to the bones of a foot. Chosen by hand: above 0.5, so that a foot
that lies flat is within its ring."""

_angles = np.linspace(0.0, 2.0 * np.pi, N_SEGMENTS + 1)
_circle = np.stack([np.cos(_angles), np.sin(_angles), np.zeros(N_SEGMENTS + 1)], axis=1)
_bones: dict[int, tuple[tuple[str, ...], ...]] = {}


class Rings(NamedTuple):
    """Rings in the scene, as lines."""

    lines: Single
    """Shape (n_lines, 2, 3)."""
    colors: Single
    """Of their ends, shape (n_lines, 2, 4)."""


def forget() -> None:
    """Clear the cache, so that the next drawing reads again."""
    _bones.clear()


def rings_at(armature: bpy.types.Object, frame: float) -> Rings | None:
    """Return a ring for each part of the body in contact at a scene frame; None without any."""
    contacts = contacts_of(armature)
    if contacts is None:
        return None
    frame = played_time(armature, frame).action_frame(frame)
    standing = [is_in_contact(keys, frame) for keys in contacts]
    if not any(standing):
        return None
    bones = [
        tuple(name for name in names if name in armature.pose.bones)  # renamed since then?
        for names in _bones_of(armature)
    ]
    feet = bones[0] or bones[1]
    lines, colors = [], []
    for is_standing, names, (_, mark) in zip(standing, bones, CONTACT_ROWS, strict=True):
        if is_standing and names:
            points = _circle * _radius(armature, feet or names) + _point_under(armature, names)
            lines.append(np.stack([points[:-1], points[1:]], axis=1))
            colors.append(np.full((N_SEGMENTS, 2, 4), COLORS[mark]))
    if not lines:
        return None
    return Rings(
        np.concatenate(lines).astype(np.float32), np.concatenate(colors).astype(np.float32)
    )


def is_in_contact(keys: Array, frame: float) -> bool:
    """Return whether a part is in contact at a frame; keys hold until the next one.

    Keys have shape (n_keys, 2). Before the first key there is no contact. Frames of keys are
    32-bit numbers, and so is the frame that they are compared with.
    """
    last = int(np.searchsorted(keys[:, 0], np.float64(np.float32(frame)), side="right")) - 1
    return last >= 0 and bool(keys[last, 1] > 0.5)


def _bones_of(armature: bpy.types.Object) -> tuple[tuple[str, ...], ...]:
    """Return the bones of each part; none for parts that are not recognized."""
    if armature.session_uid not in _bones:
        try:
            joints = find_roles(armature).joints
        except InvalidMotionError:
            joints = {}
        _bones[armature.session_uid] = tuple(
            tuple(joints[role] for role in roles if role in joints) for roles in ROLES
        )
    return _bones[armature.session_uid]


def _radius(armature: bpy.types.Object, names: tuple[str, ...]) -> float:
    """Return the radius in the scene of a ring around bones."""
    length = sum(armature.data.bones[name].length for name in names)
    return float(RADIUS * length * armature.matrix_world.median_scale)


def _point_under(armature: bpy.types.Object, names: tuple[str, ...]) -> NDArray[np.float64]:
    """Return the point of the scene below the middle of bones, at the height of their end."""
    ends: list[Vector] = []
    for name in names:
        bone = armature.pose.bones[name]
        ends += [armature.matrix_world @ bone.head, armature.matrix_world @ bone.tail]
    points = np.array(ends)
    return np.append(points[:, :2].mean(axis=0), points[:, 2].min())
