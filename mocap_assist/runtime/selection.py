"""The armature and the bones that the animator means, and why a button may be grey."""

import bpy

from ...solvers.errors import InvalidMotionError
from ...solvers.settings import Choice
from ..actions.armature_read import action_of
from ..actions.armature_write import check_writable
from ..actions.marker_take import MarkerTake
from ..actions.markers import first_marker_of, holder_of, markers_of
from ..blender import compat
from ..blender.compat import Source
from ..scene import history


class Bones(Choice):
    """Bones that a button changes."""

    ALL = "all", "All bones of the armature, or all markers"
    SELECTED = "selected", "The selected bones or markers only"


def selected_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it is an armature."""
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def selected_subject(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active armature, or what holds the markers of the active empty."""
    return selected_armature(context) or holder_of(context.view_layer.objects.active)


def why_not_read(context: bpy.types.Context) -> str:
    """Return why there is nothing to read, or nothing: the reason why a button is grey."""
    subject = selected_subject(context)
    if subject is None:
        return "Select an animated armature or marker set."
    try:
        played_source(subject)
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_clean(context: bpy.types.Context) -> str:
    """Return why nothing can be cleaned, or nothing."""
    if reason := why_not_read(context):
        return reason
    try:
        check_writable(first_animated_object(selected_subject(context)))
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_change(context: bpy.types.Context) -> str:
    """Return why the motion of no armature can be changed, or nothing."""
    if selected_armature(context) is None:
        return "Select an animated armature."
    return why_not_clean(context)


def why_not_retarget(context: bpy.types.Context) -> str:
    """Return why nothing can be retargeted, or nothing."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the source armature (the one with the motion)."
    return ""


def why_not_learn(context: bpy.types.Context) -> str:
    """Return why nothing can be learned, or nothing."""
    if selected_armature(context) is None:
        return "Select an armature with the bones of the examples."
    return ""


def animated_objects(subject: bpy.types.Object) -> tuple[bpy.types.Object, ...]:
    """Return what plays the action: the armature itself, or the markers below an object."""
    return (subject,) if subject.type == "ARMATURE" else markers_of(subject)


def first_animated_object(subject: bpy.types.Object) -> bpy.types.Object:
    """Return the armature itself, or one of the markers."""
    return subject if subject.type == "ARMATURE" else first_marker_of(subject)


def played_source(subject: bpy.types.Object) -> Source:
    """Return what the armature, or the first of the markers, plays: a result, or its action."""
    player = first_animated_object(subject)
    return history.played_result(player) or action_of(player)


def played_result(subject: bpy.types.Object | None) -> Source | None:
    """Return the result of ours that the armature or the first of the markers plays."""
    return None if subject is None else history.played_result(first_animated_object(subject))


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


def chosen_markers(take: MarkerTake, choice: Bones) -> frozenset[str]:
    """Return the names of the markers to change, of which there must be one."""
    chosen = frozenset(
        name
        for name, marker in zip(take.tracks.names, take.markers, strict=True)
        if choice is Bones.ALL or marker.select_get()
    )
    if not chosen:
        raise InvalidMotionError("No markers are selected. Select some, or clean all of them.")
    return chosen
