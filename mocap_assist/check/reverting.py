"""Revert from a result to the recorded action."""

from collections.abc import Callable

import bpy

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import check_writable, keep_replaced
from ..actions.nla_strips import own_tracks, remove_deltas, remove_tracks
from ..blender import compat
from ..blender.compat import Source
from ..runtime.selection import (
    animated_objects,
    played_result,
    played_source,
    selected_subject,
)
from ..scene import history


def why_not_revert(context: bpy.types.Context) -> str:
    """Return why the selection cannot be reverted, or an empty text."""
    return why_not_play_raw(context, check_writable)


def why_not_play_raw(
    context: bpy.types.Context, check: Callable[[bpy.types.Object], None]
) -> str:
    """Return why there is no recorded action, or what a check raises, or an empty text."""
    if reason := why_no_raw(context):
        return reason
    try:
        for player in animated_objects(selected_subject(context)):
            check(player)
    except InvalidMotionError as error:
        return str(error)
    return ""


def why_no_raw(context: bpy.types.Context) -> str:
    """Return why the selection plays no result of a recorded action, or an empty text."""
    subject = selected_subject(context)
    if subject is None:
        return "Select an animated armature or marker set."
    try:
        if played_result(subject) is not None:
            return ""
        action, _ = played_source(subject)
    except InvalidMotionError as error:
        return str(error)
    if history.SOURCE in action:
        return f"The raw action of {action.name} is not in this file."
    if history.GIVEN_BY in action:
        return f"{action.name} was made from another object; it has no raw action to revert to."
    return f"{action.name} is the raw action. Press Fix My Take or Clean first."


def revert_to_recorded(subject: bpy.types.Object) -> str:
    """Assign the recorded action to an armature, or to each of the markers below an object."""
    message = ""
    for player in animated_objects(subject):
        played = history.played_result(player)
        raw = played and history.raw_of(*played)
        if played and raw:
            _revert(player, raw)
            message = message or (
                f"{subject.name} plays {raw[0].name} again; {played[0].name} is kept."
            )
    if message and played_result(subject) is not None:
        return " ".join([message, "Other NLA strips stay and play results."])
    return message


def _revert(player: bpy.types.Object, raw: Source) -> None:
    """Assign the recorded action and slot; remove our own NLA tracks of its results."""
    animation = player.animation_data
    keep_replaced(animation, raw[:1])
    remove_deltas(animation, raw[0])
    remove_tracks(animation, own_tracks(animation, raw))
    compat.assign(player, *raw)
