"""Clips as strips of an armature's NLA."""

import bpy


def add_strip(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frame: int,
    scale: float,
) -> bpy.types.NlaStrip:
    """Put an action on a track of its own at a frame, stretched in time by a factor.

    What the armature plays is pushed down first: an active action would hide the strip.
    """
    animation = armature.animation_data or armature.animation_data_create()
    if animation.action is not None and animation.action_slot is not None:
        played, played_slot = animation.action, animation.action_slot
        first, last = played.frame_range
        animation.action = None
        below = _strip(animation, played, played_slot, int(first))
        below.frame_start, below.frame_end = first, last
    strip = _strip(animation, action, slot, frame)
    strip.extrapolation = "NOTHING"  # before and after it, what lies below is seen
    strip.scale = scale
    return strip


def _strip(
    animation: bpy.types.AnimData,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frame: int,
) -> bpy.types.NlaStrip:
    track = animation.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, frame, action)
    strip.action_slot = slot
    return strip
