"""The way back from a result to the action that was recorded."""

import bpy

from .scene import compat, history
from .selection import selected_armature


def why_not_revert(context: bpy.types.Context) -> str:
    """Return why the button is grey, or nothing."""
    armature = selected_armature(context)
    if armature is None:
        return "Select an armature."
    if history.played_result(armature) is None:
        return (
            f"{armature.name} plays no result of Mocap Assist whose raw action is in this file."
        )
    return ""


def revert(armature: bpy.types.Object) -> str:
    """Assign the recorded action and slot again; NLA tracks of results made from it go."""
    result, _ = history.played_result(armature)
    raw, slot = history.raw_of(result)
    tracks = armature.animation_data.nla_tracks
    for track in list(tracks):
        sources = [strip.action and history.raw_of(strip.action) for strip in track.strips]
        if sources == [(raw, slot)] and not track.mute:
            tracks.remove(track)
    compat.assign(armature, raw, slot)
    return f"{armature.name} plays {raw.name} again; {result.name} is kept."
