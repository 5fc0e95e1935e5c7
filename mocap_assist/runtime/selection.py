"""The selected armature, bones and markers, and why a button is unavailable."""

from collections.abc import Sequence

import bpy

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.settings import Choice
from ..actions.armature_read import action_of
from ..actions.armature_write import check_writable
from ..actions.markers.holders import first_marker_of, holder_of, markers_of, point_names
from ..blender import compat
from ..blender.compat import Source
from ..scene import history
from ..scene.played_time import PlayedTime, played_times


class Bones(Choice):
    """Bones that a button changes."""

    ALL = "all", "Use all bones of the armature, or all markers"
    SELECTED = "selected", "Use only the selected bones or markers"


def selected_armature(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it is an armature."""
    active = context.view_layer.objects.active
    return active if active is not None and active.type == "ARMATURE" else None


def selected_subject(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active armature, or the parent of the active marker."""
    return selected_armature(context) or holder_of(context.view_layer.objects.active)


def why_not_active(context: bpy.types.Context) -> str:
    """Return what to do where an armature or marker is selected, but not active; or nothing."""
    if selected_subject(context) is not None:
        return ""
    selected = context.view_layer.objects.selected
    if any(each.type == "ARMATURE" or holder_of(each) for each in selected):
        return "Shift-click the selected armature or marker to make it active."
    return ""


def why_not_read(context: bpy.types.Context) -> str:
    """Return why no motion can be read, or an empty text."""
    subject = selected_subject(context)
    if subject is None:
        return why_not_active(context) or "Select an animated armature or marker set."
    try:
        played_source(subject)
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_clean(context: bpy.types.Context) -> str:
    """Return why the selection cannot be cleaned, or an empty text."""
    if reason := why_not_read(context):
        return reason
    try:
        check_writable(first_animated_object(selected_subject(context)))
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_not_change(context: bpy.types.Context) -> str:
    """Return why the motion of the selection cannot be changed, or an empty text."""
    if selected_armature(context) is None:
        return "Select an animated armature."
    return why_not_clean(context)


def why_not_retarget(context: bpy.types.Context) -> str:
    """Return why the selection cannot be retargeted, or an empty text."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the source armature (the one with the motion)."
    return ""


def why_not_learn(context: bpy.types.Context) -> str:
    """Return why the selection cannot be learned from, or an empty text."""
    if selected_armature(context) is None:
        return "Select an armature with the bones of the examples."
    return ""


def animated_objects(subject: bpy.types.Object) -> tuple[bpy.types.Object, ...]:
    """Return the animated objects: the armature itself, or the markers below a parent."""
    return (subject,) if subject.type == "ARMATURE" else markers_of(subject)


def first_animated_object(subject: bpy.types.Object) -> bpy.types.Object:
    """Return the armature itself, or one of the markers."""
    return subject if subject.type == "ARMATURE" else first_marker_of(subject)


def played_source(subject: bpy.types.Object) -> Source:
    """Return the result or action that the armature, or the first of the markers, plays."""
    player = first_animated_object(subject)
    return history.played_result(player) or action_of(player)


def played_result(subject: bpy.types.Object | None) -> Source | None:
    """Return the result of Mocap Assist that the armature or the first marker plays."""
    return None if subject is None else history.played_result(first_animated_object(subject))


def shown_frames(
    context: bpy.types.Context, issue: bpy.types.PropertyGroup
) -> tuple[float, float]:
    """Return the first and last scene frame of an issue, as the selection plays its action."""
    subject = selected_subject(context)
    if subject is None:
        return issue.start, issue.stop
    times = played_times(first_animated_object(subject))
    return _time_of(times, issue.start).scene_range(issue.start, issue.stop)


def timeline_frames(subject: bpy.types.Object, frames: Array) -> list[float]:
    """Return the scene frames at which a subject plays these frames of its action."""
    times = played_times(first_animated_object(subject))
    return [_time_of(times, frame).scene_frame(frame) for frame in frames.tolist()]


def _time_of(times: Sequence[PlayedTime], frame: float) -> PlayedTime:
    """Return the time of the first strip that plays a frame of the action, or of the first."""
    plays = (each for each in times if each.first <= frame <= each.last)
    return next(plays, times[0])


def chosen_bones(armature: bpy.types.Object, choice: Bones) -> frozenset[str]:
    """Return the names of the bones to change; raise InvalidMotionError if there are none."""
    bones = armature.pose.bones
    if choice is Bones.ALL:
        return frozenset(bone.name for bone in bones)
    selected = frozenset(bone.name for bone in bones if compat.is_selected(bone))
    if not selected:
        raise InvalidMotionError(
            "No bones are selected. Select some in Pose Mode, or clean all bones."
        )
    return selected


def select_only_bone(armature: bpy.types.Object, name: str) -> None:
    """Select a bone and no other; make it active."""
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name == name)
    armature.data.bones.active = armature.data.bones.get(name)


def chosen_parts(subject: bpy.types.Object, choice: Bones) -> frozenset[str]:
    """Return the names of the bones or markers to change; raise InvalidMotionError if none."""
    if subject.type == "ARMATURE":
        return chosen_bones(subject, choice)
    markers = markers_of(subject)
    chosen = frozenset(
        name
        for name, marker in zip(point_names(markers), markers, strict=True)
        if choice is Bones.ALL or marker.select_get()
    )
    if markers and not chosen:
        raise InvalidMotionError("No markers are selected. Select some, or clean all of them.")
    return chosen
