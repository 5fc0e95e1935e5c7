"""The armature and the bones that the animator means, and why a button may be grey."""

import bpy

from ..solvers.errors import InvalidMotionError
from .clean_choices import Bones
from .scene import compat, history
from .scene.armature_read import action_of
from .scene.armature_write import check_writable
from .scene.compat import Source


def selected_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it is an armature."""
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def why_not_read(context: bpy.types.Context) -> str:
    """Return why there is nothing to read, or nothing: the reason why a button is grey."""
    armature = selected_armature(context)
    if armature is None:
        return "Select an armature that plays a captured action."
    try:
        played_source(armature)
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_clean(context: bpy.types.Context) -> str:
    """Return why nothing can be cleaned, or nothing."""
    if reason := why_not_read(context):
        return reason
    try:
        check_writable(selected_armature(context))
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_retarget(context: bpy.types.Context) -> str:
    """Return why nothing can be retargeted, or nothing."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the armature whose motion another one is to make."
    return ""


def why_not_learn(context: bpy.types.Context) -> str:
    """Return why nothing can be learned, or nothing."""
    if selected_armature(context) is None:
        return "Select an armature that has the bones of the examples."
    return ""


def played_source(armature: bpy.types.Object) -> Source:
    """Return what the armature plays: a result of ours, or its action."""
    return history.played_result(armature) or action_of(armature)


def chosen_bones(armature: bpy.types.Object, choice: Bones) -> frozenset[str]:
    """Return the names of the bones to change, of which there must be one."""
    bones = armature.pose.bones
    if choice is Bones.ALL:
        return frozenset(bone.name for bone in bones)
    selected = frozenset(bone.name for bone in bones if compat.is_selected(bone))
    if not selected:
        raise InvalidMotionError(
            "No bones are selected. Select some in Pose Mode, or clean all bones."
        )
    return selected
