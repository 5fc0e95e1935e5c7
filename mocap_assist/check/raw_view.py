"""Let an armature or markers play the recorded action for a while, and then the result again.

The recorded action is really assigned, so meshes, constraints and children follow it. Where the
result plays on NLA strips that were moved, scaled or cut, the recorded action gets such strips
on a track above. What was played before returns on every ending: also before a file is saved or
loaded, before undo, and before a render.
"""

from collections.abc import Callable
from contextlib import suppress
from typing import Any, NamedTuple

import bpy
from bpy.app import handlers

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import check_not_tweaked
from ..actions.nla_strips import TIMING
from ..blender import compat
from ..blender.block_references import BlockReference, SourceReference
from ..runtime.selection import animated_objects, selected_subject
from ..runtime.watch import why_busy
from ..scene import history
from ..scene.played_time import PlayedTime, played_strips, played_times
from .reverting import why_not_play_raw

POSE = ("location", "rotation_quaternion", "rotation_euler", "rotation_axis_angle", "scale")
"""Values of an object or a bone that only the recorded action may animate."""


class _Shown(NamedTuple):
    """An object that shows its recorded action; the references stay valid after undo."""

    player: BlockReference
    raw: SourceReference
    before: SourceReference | None
    """Action that was assigned; None where only NLA tracks play."""
    pose: dict[str, dict[str, Any]]
    """By bone, the values before; those of the object have an empty name."""
    frame: float
    """Of the scene, to which this pose belongs."""
    track: str
    """Name of the NLA track that plays the recorded action; empty where it is assigned."""


_shown: list[_Shown] = []
at_end: list[Callable[[], None]] = []
"""Called after the result plays again."""


def why_not_show_raw(context: bpy.types.Context) -> str:
    """Return why the recorded action cannot be shown, or an empty text."""
    return why_busy() or why_not_play_raw(context, check_not_tweaked)


def show_raw(context: bpy.types.Context) -> str:
    """Assign the recorded action to the selection; return a message for the status bar."""
    restore_played()
    message = ""
    for player in animated_objects(selected_subject(context)):
        played = history.played_result(player)
        if played and (raw := history.raw_of(*played)):
            history.hold_result(player, played)
            shown = _remember(player, raw)
            _shown.append(shown._replace(track=_play(player, raw)))
            message = message or f"{raw[0].name} (raw)"
    return message


def is_shown() -> bool:
    """Whether the recorded action is shown in place of the result."""
    return bool(_shown)


@handlers.persistent
def restore_played(*_: object) -> None:
    """Assign again what was played before; a second call has no effect."""
    history.release_results()
    if not _shown:
        return
    while _shown:
        with suppress(InvalidMotionError):  # deleted meanwhile
            _restore(_shown.pop())
    for listener in at_end:
        listener()


def _remember(player: bpy.types.Object, raw: compat.Source) -> _Shown:
    animation = player.animation_data
    before = animation.action and SourceReference.of((animation.action, animation.action_slot))
    posed = {"": player} | (
        {bone.name: bone for bone in player.pose.bones} if player.pose else {}
    )
    pose = {
        name: {each: _copied(getattr(holder, each)) for each in POSE}
        for name, holder in posed.items()
    }
    references = BlockReference.of(player), SourceReference.of(raw), before or None
    return _Shown(*references, pose, bpy.context.scene.frame_current_final, "")


def _play(player: bpy.types.Object, raw: compat.Source) -> str:
    """Play the recorded action in the time of the result; return the name of a new track."""
    if all(each[:2] == PlayedTime()[:2] for each in played_times(player)):
        compat.assign(player, *raw)
        return ""
    animation, (action, slot) = player.animation_data, raw
    animation.action = None
    strips = played_strips(player)
    track = animation.nla_tracks.new()
    track.name = action.name
    for strip in strips:
        same = track.strips.new(action.name, int(strip.frame_start), action)
        same.action_slot = slot
        for name in TIMING:
            setattr(same, name, getattr(strip, name))
    return str(track.name)


def _copied(value: Any) -> Any:
    return value.copy() if hasattr(value, "copy") else tuple(value)


def _ends(animation: bpy.types.AnimData, shown: _Shown) -> bool:
    """Remove the track of the recorded action; return whether that was still played."""
    named = [each for each in animation.nla_tracks if each.name == shown.track]
    if named:  # the uppermost: the animator may have one of this name below
        animation.nla_tracks.remove(named[-1])
        return animation.action is None
    return bool(animation.action == shown.raw.find()[0])


def _restore(shown: _Shown) -> None:
    """Assign what was played, unless another action was assigned in the meantime."""
    player = shown.player.find()
    animation = player.animation_data
    if animation is None or not _ends(animation, shown):
        return
    if shown.before is None:
        animation.action = None
    else:
        compat.assign(player, *shown.before.find())
    if bpy.context.scene.frame_current_final == shown.frame:
        bpy.context.view_layer.update()  # a pose without keys is set after the action's
    for name, values in shown.pose.items():
        holder = player if not name else player.pose.bones.get(name)
        if holder is not None:
            for each, value in values.items():
                setattr(holder, each, value)


_BEFORE = ("load_pre", "save_pre", "undo_pre", "redo_pre", "render_init")


def register() -> None:
    """Restore the result before anything that would store the recorded action in its place."""
    for name in _BEFORE:
        getattr(handlers, name).append(restore_played)


def unregister() -> None:
    """Restore, and remove the handlers."""
    restore_played()
    for name in _BEFORE:
        getattr(handlers, name).remove(restore_played)
