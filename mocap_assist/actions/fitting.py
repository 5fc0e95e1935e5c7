"""Find the armature that an action was made for."""

import bpy

from ..blender import compat
from .bone_channels import animated_curves, bone_path


def plays_action(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Whether the action is the one that the armature plays now."""
    animation = armature.animation_data
    return animation is not None and animation.action == action


def plays_slot(
    armature: bpy.types.Object, action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> bool:
    """Whether the armature plays this slot of the action now, or in one of its strips."""
    animation = armature.animation_data
    if animation is None:
        return False
    strips = [strip for track in animation.nla_tracks for strip in track.strips]
    played = [(animation.action, animation.action_slot)]
    played += [(strip.action, strip.action_slot) for strip in strips]
    return any(
        its_action == action and its_slot is not None and its_slot.handle == slot.handle
        for its_action, its_slot in played
    )


def fits_armature(
    armature: bpy.types.Object, action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> bool:
    """Whether most animated bones of the action are bones of the armature."""
    paths = {path.rpartition(".")[0] for path, _ in animated_curves(action, slot)}
    bones = {bone_path(bone.name, "")[:-1] for bone in armature.pose.bones}
    animated = {path for path in paths if path.startswith("pose.bones[")}
    return bool(animated) and 2 * len(animated & bones) > len(animated)


def fitting_slots(
    armature: bpy.types.Object, action: bpy.types.Action
) -> list[bpy.types.ActionSlot]:
    """Return the slots of an action that move the armature."""
    return [
        slot
        for slot in action.slots
        if slot.target_id_type in compat.TARGETS and fits_armature(armature, action, slot)
    ]
