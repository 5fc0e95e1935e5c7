"""What was done to an action, kept in the action itself, and the way back to the raw one."""

import json
import tomllib
from dataclasses import asdict
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any

import bpy

from ...solvers.settings import Settings
from . import compat

HISTORY = "mocap_assist_history"
SOURCE = "mocap_assist_source"


def record(
    action: bpy.types.Action,
    source: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    entry: dict[str, Any],
) -> None:
    """Note in `action` what was done to `source`, and by which version.

    An action that was made from a result keeps the result's entries and its raw source.
    """
    entry = {"version": version(), "source": source.name, "slot": slot.identifier} | entry
    action[HISTORY] = json.dumps([*history(source), entry], ensure_ascii=False)
    # A pointer follows the source through renaming, and keeps it in the saved file.
    action[SOURCE] = source.get(SOURCE) or source


def history(action: bpy.types.Action) -> list[dict[str, Any]]:
    """Return what was done, oldest first; nothing for an action of other origin."""
    try:
        entries = json.loads(action.get(HISTORY, "[]"))
    except (TypeError, ValueError):  # edited by hand
        return []
    return entries if isinstance(entries, list) else []


def raw_of(action: bpy.types.Action) -> tuple[bpy.types.Action, bpy.types.ActionSlot] | None:
    """Return the recorded action and slot that a result was made from, if both still exist."""
    source, entries = action.get(SOURCE), history(action)
    if not isinstance(source, bpy.types.Action) or not entries:
        return None
    slot = compat.slot_called(source, entries[0].get("slot", ""))
    return None if slot is None else (source, slot)


def raw_source(
    armature: bpy.types.Object,
) -> tuple[bpy.types.Action, bpy.types.ActionSlot] | None:
    """Return the recorded action behind the result that an armature plays, if it plays one."""
    animation = armature.animation_data
    if animation is None:
        return None
    strips = [strip for track in animation.nla_tracks for strip in track.strips]
    played = [animation.action, *(strip.action for strip in reversed(strips))]
    found = (raw_of(action) for action in played if action is not None)
    return next((source for source in found if source is not None), None)


def plain(*settings: Settings) -> dict[str, Any]:
    """Return settings as JSON-ready values, by name."""
    values = {name: value for each in settings for name, value in asdict(each).items()}
    return {
        name: value.value if isinstance(value, Enum) else value
        for name, value in values.items()
    }


@cache
def version() -> str:
    """Return the extension's version, which stands in its manifest alone."""
    manifest = Path(__file__).parents[2] / "blender_manifest.toml"
    return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])
