"""What was done to an action, kept in the action itself, and the way back to the raw one."""

import json
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import bpy

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


@cache
def version() -> str:
    """Return the extension's version, which stands in its manifest alone."""
    manifest = Path(__file__).parents[2] / "blender_manifest.toml"
    return str(tomllib.loads(manifest.read_text(encoding="utf-8"))["version"])
