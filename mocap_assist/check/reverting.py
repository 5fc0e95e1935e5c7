"""Revert from a result to the recorded action."""

import bpy

from ..actions.armature_write import keep_replaced, remove_deltas
from ..blender import compat
from ..blender.compat import Source
from ..runtime.selection import animated_objects, played_result, selected_subject
from ..scene import history


def why_not_revert(context: bpy.types.Context) -> str:
    """Return why the selection cannot be reverted, or an empty text."""
    subject = selected_subject(context)
    if subject is None:
        return "Select an animated armature or marker set."
    if played_result(subject) is None:
        return (
            f"The action of {subject.name} is not a result of Mocap Assist, or its raw action"
            " is not in this file."
        )
    return ""


def revert(subject: bpy.types.Object) -> str:
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
    return message


def _revert(player: bpy.types.Object, raw: Source) -> None:
    """Assign the recorded action and slot; remove NLA tracks of its results."""
    keep_replaced(player.animation_data, raw[:1])
    tracks = player.animation_data.nla_tracks
    remove_deltas(player.animation_data, raw[0])
    for track in list(tracks):
        sources = [
            strip.action and history.raw_of(strip.action, strip.action_slot)
            for strip in track.strips
        ]
        if sources == [raw] and not track.mute:
            tracks.remove(track)
    compat.assign(player, *raw)
