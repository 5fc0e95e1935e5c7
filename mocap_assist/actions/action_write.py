"""Write a new action for an armature, from channels of its bones."""

from collections.abc import Mapping

import bpy
import numpy as np

from ...solvers.arrays import Array
from ..blender import compat
from ..blender.block_references import (
    BlockReference,
    SourceReference,
    changed_during_solve,
    kept_when_complete,
)
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, should_yield
from ..scene.controls import BoneKeys
from .bone_channels import bone_path
from .curves import CONSTANT, deselect, write_first
from .rotation_modes import channels_from_quaternions, rotation_property


@Sliced
def write_action(
    armature: bpy.types.Object,
    name: str,
    frames: Array,
    keys: Mapping[str, BoneKeys],
    switches: Mapping[tuple[str, str], float],
) -> Steps[Source]:
    """Make an action that keys these bones at every frame, and nothing else.

    Parameters
    ----------
    armature : bpy.types.Object
        Not changed, nor given the action; may be linked.
    name : str
    frames : shape (n_frames,)
    keys : by bone
        Frames at which a channel is NaN get no key.
    switches : values of custom properties, by bone and property
        Those that the bone has get one key, at the first frame.

    Returns
    -------
    action, slot
    """
    here, made = BlockReference.of(armature), compat.new_action(name, armature)
    lasting = SourceReference.of(made)
    with kept_when_complete(made[0]):
        bag = compat.ensure_channelbag(*made)
        for number, (bone, channels) in enumerate(keys.items()):
            _write_bone(armature, bag, bone, frames, channels)
            if should_yield():
                yield number / len(keys)
                armature, bag = here.find(), compat.ensure_channelbag(*lasting.find())
        _write_switches(armature, bag, frames, switches)
    return lasting.find()


def _write_bone(
    armature: bpy.types.Object,
    bag: bpy.types.ActionChannelbag,
    name: str,
    frames: Array,
    channels: BoneKeys,
) -> None:
    bone = armature.pose.bones.get(name)
    if bone is None:
        raise changed_during_solve(armature.name)
    if channels.rotations is not None:
        known = np.isfinite(channels.rotations).all(axis=1)
        prop, width = rotation_property(bone.rotation_mode)
        near = np.zeros((1, width))
        near[:, 0] = float(width == len("WXYZ") and bone.rotation_mode == "QUATERNION")
        rotations = channels.rotations[known]
        if len(rotations):
            values = channels_from_quaternions(rotations, bone.rotation_mode, near)
            _write(bag, name, prop, frames[known], values)
    if channels.locations is not None:
        known = np.isfinite(channels.locations).all(axis=1)
        if known.any():
            _write(bag, name, "location", frames[known], channels.locations[known])


def _write(
    bag: bpy.types.ActionChannelbag, bone: str, prop: str, frames: Array, values: Array
) -> None:
    for index, column in enumerate(values.T):
        curve = compat.new_curve(bag, bone_path(bone, prop), index, bone)
        write_first(curve, frames, column)
        deselect(curve)


def _write_switches(
    armature: bpy.types.Object,
    bag: bpy.types.ActionChannelbag,
    frames: Array,
    switches: Mapping[tuple[str, str], float],
) -> None:
    for (bone, prop), value in switches.items():
        if bone not in armature.pose.bones or prop not in armature.pose.bones[bone]:
            continue
        path = bone_path(bone, "")[:-1] + f'["{bpy.utils.escape_identifier(prop)}"]'
        curve = compat.new_curve(bag, path, 0, bone)
        write_first(curve, frames[:1], np.array([value]), interpolation=CONSTANT)
        deselect(curve)
