"""One bone's F-Curves as rotations and locations over the frames of a take."""

from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.motion.rotations import multiply, rotate
from . import compat
from .curves import is_on, read_keys, read_values
from .gaps import unobserved
from .rig import Placement, placement_of
from .rotation_modes import quaternions_from_channels, rotation_property
from .take import BoneChannels

Array = NDArray[np.float64]
Curves = Mapping[tuple[str, int], bpy.types.FCurve]


def animated_curves(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> Curves:
    """Return the slot's F-Curves that are not muted, by data path and index."""
    bag = compat.channelbag(action, slot)
    curves = () if bag is None else bag.fcurves
    return {(curve.data_path, curve.array_index): curve for curve in curves if is_on(curve)}


def bone_path(bone: str, name: str) -> str:
    """Return the data path of a pose bone's property."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{name}'


def read_bone(bone: bpy.types.PoseBone, curves: Curves, frames: Array) -> BoneChannels:
    """Read the rotation channels of the bone's own mode, and its location.

    Channels without keys have the pose's present value.
    """
    turning, shifting = rotation_curves(bone, curves), location_curves(bone, curves)
    angles = sampled_rotation(bone, turning, frames)
    rotations = quaternions_from_channels(angles, bone.rotation_mode)
    rotations[_gaps(turning, frames)] = np.nan
    if bone.bone.use_connect and bone.parent:
        return BoneChannels(rotations, np.zeros((len(frames), 3)), bool(turning), False)
    locations = _sampled(shifting, bone.location, frames)
    locations[_gaps(shifting, frames)] = np.nan
    return BoneChannels(rotations, locations, bool(turning), bool(shifting))


def rotation_curves(bone: bpy.types.PoseBone, curves: Curves) -> dict[int, bpy.types.FCurve]:
    """Return the F-Curves of the bone's own rotation mode, by channel."""
    name, n_channels = rotation_property(bone.rotation_mode)
    return _found(curves, bone_path(bone.name, name), n_channels)


def location_curves(bone: bpy.types.PoseBone, curves: Curves) -> dict[int, bpy.types.FCurve]:
    """Return the F-Curves of the bone's location, by axis."""
    return _found(curves, bone_path(bone.name, "location"), 3)


def sampled_rotation(
    bone: bpy.types.PoseBone, turning: Mapping[int, bpy.types.FCurve], frames: Array
) -> Array:
    """Return the rotation channels at each frame, shape (n_frames, 3 or 4)."""
    name, _ = rotation_property(bone.rotation_mode)
    return _sampled(turning, getattr(bone, name), frames)


def read_space(armature: bpy.types.Object, curves: Curves, frames: Array) -> Placement:
    """Read where the armature object stands at each frame, by its own keys or as it is now.

    Raises
    ------
    InvalidMotionError
        Its scale is not the same on all axes.
    """
    bpy.context.view_layer.update()
    turn, origin, scale = placement_of(armature.matrix_world, armature.name)
    name, n_channels = rotation_property(armature.rotation_mode)
    turning, shifting = _found(curves, name, n_channels), _found(curves, "location", 3)
    if not (turning or shifting):
        n_frames = len(frames)
        return Placement(np.tile(turn, (n_frames, 1)), np.tile(origin, (n_frames, 1)), scale)
    around = armature.matrix_world @ armature.matrix_basis.inverted()
    turn, origin, size = placement_of(around, armature.name)
    angles = _sampled(turning, getattr(armature, name), frames)
    turns = quaternions_from_channels(angles, armature.rotation_mode)
    places = _sampled(shifting, armature.location, frames)
    return Placement(multiply(turn, turns), size * rotate(turn, places) + origin, scale)


def _found(curves: Curves, path: str, n_channels: int) -> dict[int, bpy.types.FCurve]:
    return {
        index: curves[path, index] for index in range(n_channels) if (path, index) in curves
    }


def _sampled(curves: Mapping[int, bpy.types.FCurve], present: object, frames: Array) -> Array:
    values = np.tile(np.array(present, dtype=np.float64), (len(frames), 1))
    for index, curve in curves.items():
        values[:, index] = read_values(curve, frames)
    return values


def _gaps(curves: Mapping[int, bpy.types.FCurve], frames: Array) -> NDArray[np.bool_]:
    if not curves:
        return np.zeros(len(frames), bool)
    return unobserved([read_keys(curve) for curve in curves.values()], frames)
