"""History of an action, stored in the action, and its link to the raw one."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from enum import Enum
from typing import Any

import bpy

from ...solvers.errors import InvalidMotionError
from ...solvers.settings import Settings
from ...solvers.version import version
from ..blender import compat
from ..blender.block_references import SourceReference
from ..blender.compat import Source
from ..blender.stored_json import load_json, store_json

HISTORY = "mocap_assist_history"
SOURCE = "mocap_assist_source"
GIVEN_BY = "mocap_assist_given_by"
DELTA_OF = "mocap_assist_delta_of"
DELTA_FROM = "mocap_assist_delta_from"
_held: dict[int, SourceReference] = {}
"""Results of objects that play the recorded action for a while, by the number of the object."""
REMADE = ("reconstruct", "simulate", "solve_skeleton", "retarget", "vary", "retrack")
"""Operations whose result counts as raw for Clean."""


def record(
    action: bpy.types.Action,
    made_from: Source,
    entry: dict[str, Any],
    *,
    of_another_rig: bool = False,
) -> None:
    """Note in `action` the operation on `made_from`, and the version.

    An action that was made from a result keeps the result's entries and its raw source. One
    made from an action `of_another_rig` is raw itself: it cannot be reverted to that.
    """
    source, slot = made_from
    entry = {"version": version(), "source": source.name, "slot": slot.identifier} | entry
    store_json(action, HISTORY, [*history(source), entry])
    if of_another_rig:
        action[GIVEN_BY] = source
        return
    # A pointer follows the source through renaming, and keeps it in the saved file.
    action[SOURCE] = source.get(SOURCE) or source


def history(action: bpy.types.Action) -> list[Mapping[str, Any]]:
    """Return what was done, oldest first; nothing for an action of other origin."""
    return [entry for entry in load_json(action, HISTORY, list) if isinstance(entry, dict)]


def given_to(action: bpy.types.Action) -> str:
    """Return the name of the armature that Retarget made it for; nothing for other actions."""
    names = [entry.get("target_armature", "") for entry in history(action)]
    return next((str(name) for name in reversed(names) if name), "")


def was_thinned(action: bpy.types.Action) -> bool:
    """Return whether Unbake made it: frames without keys are no gaps then."""
    entries = history(action)
    return bool(entries) and entries[-1].get("operation") == "reduce_keys"


def raw_of(action: bpy.types.Action, slot: bpy.types.ActionSlot | None = None) -> Source | None:
    """Return the recorded action and slot that a result was made from, if both still exist.

    A result for many markers has a slot for each; `slot` states whose recording is requested.
    """
    source, entries = action.get(SOURCE), history(action)
    if not isinstance(source, bpy.types.Action) or not entries:
        return None
    handle = None if slot is None else slot.handle  # which copies of an action share
    same = next((each for each in source.slots if each.handle == handle), None)
    found = same or compat.find_slot(source, str(entries[0].get("slot", "")))
    return None if found is None else (source, found)


def cleaned_from(played: Source) -> Source:
    """Return the source of Clean: the recorded action, or the result that replaced its motion.

    Cleaning again starts from the same action; what Reconstruct or Simulate made is kept.
    """
    action, slot = played
    while (entries := history(action)) and entries[-1].get("operation") not in REMADE:
        before = bpy.data.actions.get(str(entries[-1].get("source", "")))
        found = before and compat.find_slot(before, str(entries[-1].get("slot", "")))
        if not found or history(before) != entries[:-1]:
            return raw_of(*played) or played
        action, slot = before, found
    return action, slot


def played_result(armature: bpy.types.Object) -> Source | None:
    """Return the result of ours that an armature plays, as its action or on an NLA track.

    While the recorded action is shown for a while, that is the result that plays again after.
    """
    if (held := _held.get(armature.session_uid)) is not None:
        with suppress(InvalidMotionError):  # deleted meanwhile
            return held.find()
    player = result_player(armature)
    return None if player is None else source_of(player)


def hold_result(armature: bpy.types.Object, result: Source) -> None:
    """Let a result count as played until `release_results`, whatever is assigned."""
    _held[armature.session_uid] = SourceReference.of(result)


def release_results() -> None:
    """End all `hold_result`."""
    _held.clear()


def result_player(
    armature: bpy.types.Object,
) -> bpy.types.AnimData | bpy.types.NlaStrip | None:
    """Return what plays the result of ours: the animation of an armature, or an NLA strip.

    Muted tracks and strips play nothing. An assigned action that replaces the tracks hides
    them, unless it is the recorded one, or a fix of few bones.
    """
    animation = armature.animation_data
    if animation is None:
        return None
    for player in (animation, *playing_strips(animation)):
        source = source_of(player)
        raw = source and raw_of(source[0])
        if source and raw:
            is_below = player != animation
            return None if is_below and _hides_tracks(animation, source, raw) else player
    return None


def _hides_tracks(animation: bpy.types.AnimData, result: Source, raw: Source) -> bool:
    """Whether the assigned action replaces most of the bones of a result on a track."""
    action, slot = animation.action, animation.action_slot
    if animation.action_blend_type != "REPLACE" or not slot or action in {None, raw[0]}:
        return False
    moved = _moved_by(result)
    return 2 * len(moved & _moved_by((action, slot))) > len(moved)


def _moved_by(source: Source) -> set[str]:
    """Return the paths of the bones that an action animates; an empty one is the object."""
    bag = compat.channelbag(*source)
    return {curve.data_path.rpartition(".")[0] for curve in bag.fcurves} if bag else set()


def source_of(player: bpy.types.AnimData | bpy.types.NlaStrip) -> Source | None:
    """Return the action and slot of an animation or NLA strip; of a delta, those of its result.

    With the action below it, a delta plays the result as far as its influence goes.
    """
    if player.action is None or not player.action_slot:
        return None
    result = player.action.get(DELTA_OF)
    if not isinstance(result, bpy.types.Action):
        return player.action, player.action_slot
    slot = compat.find_slot(result, player.action_slot.identifier)
    return None if slot is None else (result, slot)


def mark_delta(delta: bpy.types.Action, base: Source, result: Source) -> None:
    """Note in a delta the actions between which it leads."""
    delta[DELTA_FROM], delta[DELTA_OF] = base[0], result[0]


def base_of_delta(action: bpy.types.Action) -> bpy.types.Action | None:
    """Return the action below a delta; None for other actions."""
    base = action.get(DELTA_FROM)
    return base if isinstance(base, bpy.types.Action) else None


def playing_strips(animation: bpy.types.AnimData) -> list[bpy.types.NlaStrip]:
    """Return the NLA strips that are not muted, those of the uppermost track first."""
    tracks = [track for track in reversed(animation.nla_tracks) if not track.mute]
    return [strip for track in tracks for strip in track.strips if not strip.mute]


def json_ready(*settings: Settings) -> dict[str, Any]:
    """Return settings as JSON-ready values, by name."""
    values = {name: value for each in settings for name, value in asdict(each).items()}
    return {
        name: value.value if isinstance(value, Enum) else value
        for name, value in values.items()
    }
