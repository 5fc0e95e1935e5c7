"""Which armature an action was made for."""

import bpy

from ..blender import compat
from .bone_channels import animated_curves, bone_path


def plays(armature: bpy.types.Object, action: bpy.types.Action) -> bool:
    """Whether the action is the one that the armature plays now."""
    animation = armature.animation_data
    return animation is not None and animation.action == action


def fits(
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
        if slot.target_id_type in compat.TARGETS and fits(armature, action, slot)
    ]
