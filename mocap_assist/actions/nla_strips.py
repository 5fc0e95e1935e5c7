"""NLA strips that play a take or its results: add them, replace their action, remove them."""

from collections.abc import Iterable

import bpy

from ..blender.compat import Source
from ..scene import history

TIMING = (
    "action_frame_start", "action_frame_end", "scale", "repeat", "use_reverse",
    "frame_start_raw", "frame_end_raw",
)  # fmt: skip
"""Properties of a strip that place its action in the scene, in the order to set them."""


def own_tracks(animation: bpy.types.AnimData, raw: Source) -> list[bpy.types.NlaTrack]:
    """Return the NLA tracks that only play results of a recorded action, as they were laid.

    Their strips may have been moved, scaled or cut. Muted ones are left out.
    """
    return [track for track in animation.nla_tracks if _is_of_results(track, raw)]


def _is_of_results(track: bpy.types.NlaTrack, raw: Source) -> bool:
    return (
        _is_own(track)
        and not track.mute
        and all(
            history.raw_of(strip.action, strip.action_slot) == raw
            and strip.blend_type == "REPLACE"
            and not strip.mute
            for strip in track.strips
        )
    )


def _is_own(track: bpy.types.NlaTrack) -> bool:
    """Whether a track is as `new_strip` made it: other actions and names are the animator's."""
    names = {strip.action.name if strip.action else "" for strip in track.strips}
    return names == {track.name} and _is_unlocked(track)


def _is_unlocked(track: bpy.types.NlaTrack) -> bool:
    """Whether neither the animator nor the linked file of an override holds a track."""
    return not track.lock and not track.is_override_data


def strip_of_result(armature: bpy.types.Object, raw: Source) -> bpy.types.NlaStrip | None:
    """Return the strip of our own that plays a whole result of a recorded action, or None."""
    player = history.result_player(armature)
    for track in own_tracks(armature.animation_data, raw):
        strip = track.strips[0]
        if strip == player and len(track.strips) == 1:
            part = strip.action_frame_start, strip.action_frame_end
            return strip if part == tuple(strip.action.frame_range) else None
    return None


def remove_tracks(animation: bpy.types.AnimData, tracks: Iterable[bpy.types.NlaTrack]) -> None:
    """Remove NLA tracks; their actions stay in the file."""
    for track in tracks:
        for strip in track.strips:
            keep_action(strip.action)
        animation.nla_tracks.remove(track)


def keep_action(action: bpy.types.Action | None) -> None:
    """Let an action stay in the file after nothing plays it any more."""
    if action is not None and action.library is None:
        action.use_fake_user = True


def remove_deltas(animation: bpy.types.AnimData, base: bpy.types.Action) -> None:
    """Remove the delta tracks of a recorded action, and the tracks below that play it."""
    for pair in delta_tracks(animation, base):
        remove_tracks(animation, pair)


def delta_tracks(
    animation: bpy.types.AnimData, base: bpy.types.Action
) -> list[tuple[bpy.types.NlaTrack, ...]]:
    """Return each delta track of a recorded action, after the track below that plays it."""
    found: list[tuple[bpy.types.NlaTrack, ...]] = []
    below = None
    for track in animation.nla_tracks:
        actions = [strip.action for strip in track.strips]
        if _is_own(track) and all(history.base_of_delta(each) == base for each in actions):
            has_base = below is not None and {each.action for each in below.strips} == {base}
            found.append((below, track) if has_base and _is_unlocked(below) else (track,))
        below = track
    return found


def new_strip(animation: bpy.types.AnimData, source: Source) -> bpy.types.NlaStrip:
    """Put an action on a new NLA track of its name, at its own frames."""
    action, slot = source
    track = animation.nla_tracks.new()
    track.name = action.name
    strip = track.strips.new(action.name, int(action.frame_range[0]), action)
    strip.action_slot = slot
    strip.frame_start, strip.frame_end = action.frame_range  # not always whole frames
    return strip


def play_in_place(strip: bpy.types.NlaStrip, source: Source) -> bool:
    """Let a strip play another action where it was moved and scaled; return whether it fits.

    An action of other frames would not: then it plays at its own. The track is renamed, too.
    """
    before = strip.action
    keep_action(before)
    action, slot = source
    is_same_range = tuple(before.frame_range) == tuple(action.frame_range)
    timing = [getattr(strip, name) for name in TIMING]
    (track,) = (
        each
        for each in strip.id_data.animation_data.nla_tracks
        if strip in each.strips.values()
    )
    strip.action, strip.name = action, action.name
    strip.action_slot = slot
    track.name = action.name
    if is_same_range:
        for name, value in zip(TIMING, timing, strict=True):
            setattr(strip, name, value)
    else:
        put_at_own_frames(strip)
    return is_same_range


def put_at_own_frames(strip: bpy.types.NlaStrip) -> None:
    """Let a strip play its action once, at the frames of the action."""
    strip.scale = strip.repeat = 1.0
    strip.action_frame_start, strip.action_frame_end = strip.action.frame_range
    strip.frame_start, strip.frame_end = strip.action.frame_range
