"""The way back from a result to the action that was recorded."""

import bpy

from ..blender import compat
from ..blender.compat import Source
from ..runtime.selection import animated_objects, played_result, selected_subject
from ..scene import history


def why_not_revert(context: bpy.types.Context) -> str:
    """Return why the button is grey, or nothing."""
    subject = selected_subject(context)
    if subject is None:
        return "Select an animated armature or marker set."
    if played_result(subject) is None:
        return (
            f"{subject.name} plays no result of Mocap Assist whose raw action is in this file."
        )
    return ""


def revert(subject: bpy.types.Object) -> str:
    """Let an armature, or each of the markers below an object, play what was recorded."""
    said = ""
    for player in animated_objects(subject):
        played = history.played_result(player)
        raw = played and history.raw_of(*played)
        if played and raw:
            _play_again(player, raw)
            said = (
                said or f"{subject.name} plays {raw[0].name} again; {played[0].name} is kept."
            )
    return said


def _play_again(player: bpy.types.Object, raw: Source) -> None:
    """Assign the recorded action and slot; NLA tracks of results made from it go."""
    tracks = player.animation_data.nla_tracks
    for track in list(tracks):
        made_from = [
            strip.action and history.raw_of(strip.action, strip.action_slot)
            for strip in track.strips
        ]
        if made_from == [raw] and not track.mute:
            tracks.remove(track)
    compat.assign(player, *raw)
