"""NLA strips that play a take or its results: add them, replace their action, remove them."""

import bpy

from ..blender.compat import Source
from ..scene import history


def remove_results(animation: bpy.types.AnimData, raw: Source) -> None:
    """Remove the NLA strips that play results of a recorded action, and tracks left empty.

    Muted ones stay, and so do other strips of their tracks.
    """
    remove_deltas(animation, raw[0])
    for strip in history.playing_strips(animation):
        if strip.action and history.raw_of(strip.action, strip.action_slot) == raw:
            track = next(each for each in animation.nla_tracks if strip in each.strips.values())
            track.strips.remove(strip)
            if not track.strips:
                animation.nla_tracks.remove(track)


def remove_deltas(animation: bpy.types.AnimData, base: bpy.types.Action) -> None:
    """Remove the delta tracks of a recorded action, and the tracks below that play it."""
    for pair in delta_tracks(animation, base):
        for track in pair:
            animation.nla_tracks.remove(track)


def delta_tracks(
    animation: bpy.types.AnimData, base: bpy.types.Action
) -> list[tuple[bpy.types.NlaTrack, ...]]:
    """Return each delta track of a recorded action, after the track below that plays it."""
    found: list[tuple[bpy.types.NlaTrack, ...]] = []
    below = None
    for track in animation.nla_tracks:
        actions = [strip.action for strip in track.strips if strip.action]
        if actions and all(history.base_of_delta(action) == base for action in actions):
            plays_base = below is not None and {each.action for each in below.strips} == {base}
            found.append((below, track) if plays_base else (track,))
        below = track
    return found


def new_strip(animation: bpy.types.AnimData, source: Source) -> bpy.types.NlaStrip:
    """Put an action on a new NLA track, at its own frames."""
    action, slot = source
    track = animation.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(action.frame_range[0]), action)
    strip.action_slot = slot
    strip.frame_start, strip.frame_end = action.frame_range  # not always whole frames
    return strip


def assign_to_strip(strip: bpy.types.NlaStrip, source: Source) -> None:
    """Let a strip play an action at the action's own frames."""
    action, slot = source
    strip.action, strip.name = action, action.name
    strip.action_slot = slot
    strip.action_frame_start, strip.action_frame_end = action.frame_range
    strip.frame_start, strip.frame_end = action.frame_range
