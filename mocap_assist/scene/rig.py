"""The rest pose and the placement of an armature, as plain values."""

from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.rotations import inverse, multiply, quaternion_from_matrix, rotate

MAX_SKEW = 1e-3
"""Deviation, a ratio, of a matrix from a rotation and one scale that is only rounding."""
MAX_COORDINATE = 1e12
"""Units of the scene; Blender keeps 3.4e38 where infinity is set."""
END = "mocap_assist_end"
"""Custom property of bones whose tail was never captured."""


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones of one armature, parents first.

    Attributes
    ----------
    bones : tuple of str
    parents : tuple of int, -1 for bones without one
    rest_rotations : shape (n_bones, 4), heads, tails : shape (n_bones, 3)
        Rest pose in the armature's own space and unit.
    modes : tuple of str
        Blender's rotation modes.
    connected : tuple of bool
        These bones ignore their location.
    ends : tuple of bool
        Of these bones only the head is a joint; what is beyond was never captured.
    """

    bones: tuple[str, ...]
    parents: tuple[int, ...]
    rest_rotations: Array
    heads: Array
    tails: Array
    modes: tuple[str, ...]
    connected: tuple[bool, ...]
    ends: tuple[bool, ...]

    def chain_to(self, bone: int) -> list[int]:
        """Return the bones above `bone`, topmost first."""
        above: list[int] = []
        while (bone := self.parents[bone]) >= 0:
            above.append(bone)
        return above[::-1]

    def subtree(self, bone: int) -> list[int]:
        """Return `bone` and all bones below it, parents first."""
        inside = {bone}
        for later in range(bone + 1, len(self.bones)):
            if self.parents[later] in inside:
                inside.add(later)
        return sorted(inside)


@dataclass(frozen=True, eq=False)
class Placement:
    """Transform of a space to the world, per frame: v maps to scale * rotate(v) + origin."""

    rotations: Array
    """Shape (n_frames, 4)."""
    origins: Array
    """Shape (n_frames, 3), meters."""
    scale: float

    def in_unit(self, meters: float) -> "Placement":
        """Return the placement with its meters interpreted as units of this length."""
        return Placement(self.rotations, meters * self.origins, meters * self.scale)

    def points(self, points: Array) -> Array:
        """Take points, shape (n_frames, 3) or (3,), from the space to the world."""
        return np.asarray(self.scale * rotate(self.rotations, points) + self.origins)

    def points_back(self, points: Array) -> Array:
        """Take points, shape (n_frames, 3), from the world to the space."""
        return np.asarray(rotate(inverse(self.rotations), points - self.origins) / self.scale)

    def moved(self, rotations: Array, locations: Array, pivot: Array) -> "Placement":
        """Return the placement below a parent that rotates about `pivot` and translates."""
        rotated = multiply(self.rotations, rotations)
        origins = self.points(pivot + locations) - self.scale * rotate(rotated, pivot)
        return Placement(rotated, origins, self.scale)


def read_rig(armature: bpy.types.Object) -> Rig:
    """Read the rest pose.

    Raises InvalidMotionError for an armature without bones, or with some that are too long.
    """
    bones = list(armature.data.bones)  # Blender lists parents before their children
    if not bones:
        raise InvalidMotionError(f"The armature {armature.name} has no bones.")
    order = {bone.name: index for index, bone in enumerate(bones)}
    rest = np.array([bone.matrix_local for bone in bones], dtype=np.float64)
    odd = ~(np.abs(rest) <= MAX_COORDINATE).all(axis=(1, 2))
    if odd.any():
        raise InvalidMotionError(
            f"The rest position of {bones[odd.argmax()].name} in {armature.name} is not a"
            " number or far too large. Move the bone in Edit Mode."
        )
    return Rig(
        bones=tuple(order),
        parents=tuple(order[bone.parent.name] if bone.parent else -1 for bone in bones),
        rest_rotations=quaternion_from_matrix(rest[:, :3, :3]),
        heads=rest[:, :3, 3],
        tails=np.array([bone.tail_local for bone in bones], dtype=np.float64),
        modes=tuple(armature.pose.bones[bone.name].rotation_mode for bone in bones),
        connected=tuple(bone.use_connect and bone.parent is not None for bone in bones),
        ends=tuple(bool(bone.get(END)) for bone in bones),
    )


def placement_of(matrix: Matrix, name: str) -> tuple[Array, Array, float]:
    """Split a world matrix into rotation, translation and uniform scale.

    Raises
    ------
    InvalidMotionError
        The scale differs between axes, is zero or mirrors, so that there are no meters; or
        something is not a number.
    """
    check_finite(matrix, name)
    array = np.array(matrix, dtype=np.float64)
    linear = array[:3, :3]
    volume = np.linalg.det(linear)
    if volume > 0.0:
        scale = float(np.cbrt(volume))
        rotation = linear / scale
        if np.abs(rotation @ rotation.T - np.eye(3)).max() <= MAX_SKEW:
            return quaternion_from_matrix(rotation), array[:3, 3], scale
    sizes = ", ".join(f"{size:.3g}" for size in np.linalg.norm(linear, axis=0))
    fault = f"is scaled unevenly or sheared ({sizes} along X, Y, Z)"
    if volume <= 0.0:
        fault = "is mirrored by a negative scale" if volume else "has scale 0"
    raise InvalidMotionError(
        f"{name} {fault}. Give it one positive scale on all axes, or apply the scale."
    )


def check_finite(matrix: Matrix, name: str) -> None:
    """Raise InvalidMotionError if a matrix has NaN or other invalid numbers."""
    if not (np.abs(np.array(matrix, dtype=np.float64)) <= MAX_COORDINATE).all():
        raise InvalidMotionError(
            f"The location, rotation or scale of {name} is not a number or far too large at the"
            " current frame. Set it again, or delete the key that sets it."
        )
