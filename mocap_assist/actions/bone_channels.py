"""One bone's F-Curves as rotations and locations over the frames of a take."""

from collections.abc import Iterator, Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.rotations import multiply, rotate
from ..blender import compat
from ..scene.rig import Placement, placement_of
from .curves import Channel
from .gaps import unobserved_frames
from .rotation_modes import quaternions_from_channels, rotation_property
from .take import BoneChannels

Curves = Mapping[tuple[str, int], Channel]

REDUNDANT_CHANGE_RAD = np.radians(1.0)
"""Radians or quaternion components by which a bone may differ across keys that an exporter
removed as redundant. Measured: Blender's FBX exporter left up to 0.01 across three keys or more
in eight takes of six makers."""
REDUNDANT_CHANGE_FRACTION = 1e-3
"""Fraction of a location's largest value or of the bone's length, likewise. By definition of
Blender's FBX exporter, which tolerates as much of the value."""


def animated_curves(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> Curves:
    """Return the slot's F-Curves that are not muted, by data path and index."""
    bag = compat.channelbag(action, slot)
    channels = map(Channel, () if bag is None else bag.fcurves)
    return {
        (each.curve.data_path, each.curve.array_index): each for each in channels if each.is_on
    }


def animated_paths(action: bpy.types.Action, slot: bpy.types.ActionSlot) -> Iterator[str]:
    """Yield the data paths of the slot's F-Curves that are not muted, one for each curve.

    An iterator, because panels read them at every redraw and often need only the first few.
    """
    bag = compat.channelbag(action, slot)
    for curve in () if bag is None else bag.fcurves:
        if Channel(curve).is_on:
            yield curve.data_path


def bone_path(bone: str, name: str) -> str:
    """Return the data path of a pose bone's property."""
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"].{name}'


def read_bone(
    bone: bpy.types.PoseBone,
    curves: Curves,
    frames: Array,
    step: float | None = None,
    *,
    gaps: bool = True,
    holds_ends: bool = False,
) -> BoneChannels:
    """Read the rotation channels of the bone's own mode, and its location.

    Channels without keys have the pose's present value. `step` and `holds_ends` are those of
    `unobserved`; without `gaps` nothing is.
    """
    rotation_channels, location_channels = (
        rotation_curves(bone, curves),
        location_curves(bone, curves),
    )
    angles = sampled_rotation(bone, rotation_channels, frames)
    rotations = quaternions_from_channels(angles, bone.rotation_mode)
    is_exported = step is None  # by another program, which may have removed redundant keys
    if gaps:
        change = REDUNDANT_CHANGE_RAD * is_exported
        missing = gaps_of(
            rotation_channels, frames, step, redundant_change=change, holds_ends=holds_ends
        )
        rotations[missing] = np.nan
    if bone.bone.use_connect and bone.parent:
        return BoneChannels(
            rotations, np.zeros((len(frames), 3)), bool(rotation_channels), False
        )
    locations = sampled(location_channels, bone.location, frames)
    if gaps:
        size = max(np.abs(locations).max(), bone.bone.length)
        change = REDUNDANT_CHANGE_FRACTION * size * is_exported
        missing = gaps_of(
            location_channels, frames, step, redundant_change=change, holds_ends=holds_ends
        )
        locations[missing] = np.nan
    return BoneChannels(rotations, locations, bool(rotation_channels), bool(location_channels))


def rotation_curves(bone: bpy.types.PoseBone, curves: Curves) -> dict[int, Channel]:
    """Return the F-Curves of the bone's own rotation mode, by channel."""
    name, n_channels = rotation_property(bone.rotation_mode)
    return curves_of(curves, bone_path(bone.name, name), n_channels)


def location_curves(bone: bpy.types.PoseBone, curves: Curves) -> dict[int, Channel]:
    """Return the F-Curves of the bone's location, by axis."""
    return curves_of(curves, bone_path(bone.name, "location"), 3)


def sampled_rotation(
    bone: bpy.types.PoseBone, rotation_channels: Mapping[int, Channel], frames: Array
) -> Array:
    """Return the rotation channels at each frame, shape (n_frames, 3 or 4)."""
    name, _ = rotation_property(bone.rotation_mode)
    return sampled(rotation_channels, getattr(bone, name), frames)


def read_space(armature: bpy.types.Object, curves: Curves, frames: Array) -> Placement:
    """Read the transform of the armature object at each frame, from its keys or as it is now.

    Raises
    ------
    InvalidMotionError
        Its scale is not the same on all axes.
    """
    bpy.context.view_layer.update()
    rotation, origin, scale = placement_of(armature.matrix_world, armature.name)
    name, n_channels = rotation_property(armature.rotation_mode)
    rotation_channels, location_channels = (
        curves_of(curves, name, n_channels),
        curves_of(curves, "location", 3),
    )
    if not (rotation_channels or location_channels):
        n_frames = len(frames)
        return Placement(
            np.tile(rotation, (n_frames, 1)), np.tile(origin, (n_frames, 1)), scale
        )
    around = armature.matrix_world @ armature.matrix_basis.inverted()
    rotation, origin, size = placement_of(around, armature.name)
    angles = sampled(rotation_channels, getattr(armature, name), frames)
    rotations = quaternions_from_channels(angles, armature.rotation_mode)
    locations = sampled(location_channels, armature.location, frames)
    return Placement(
        multiply(rotation, rotations), size * rotate(rotation, locations) + origin, scale
    )


def curves_of(curves: Curves, path: str, n_channels: int) -> dict[int, Channel]:
    """Return the F-Curves of a property, by channel."""
    return {
        index: curves[path, index] for index in range(n_channels) if (path, index) in curves
    }


def sampled(curves: Mapping[int, Channel], present: object, frames: Array) -> Array:
    """Return a property, now `present`, at each frame: shape (n_frames, n_channels)."""
    values = np.tile(np.array(present, dtype=np.float64), (len(frames), 1))
    for index, channel in curves.items():
        values[:, index] = channel.values(frames)
    return values


def gaps_of(
    curves: Mapping[int, Channel],
    frames: Array,
    step: float | None = None,
    *,
    redundant_change: float = 0.0,
    holds_ends: bool = False,
) -> NDArray[np.bool_]:
    """Return where a property was not captured, shape (n_frames,); see `unobserved`."""
    if not curves or all(channel.keyed_at(frames) for channel in curves.values()):
        return np.zeros(len(frames), bool)
    keys = [channel.keys for channel in curves.values()]
    return unobserved_frames(
        keys, frames, step, redundant_change=redundant_change, holds_ends=holds_ends
    )
