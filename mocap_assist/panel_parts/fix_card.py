"""The card of Fix My Take: what was done to an action, kept in the action until accepted."""

from collections.abc import Mapping
from typing import Any

import bpy

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import FIX_CARD
from ..blender.stored_json import load_json, store_json
from ..runtime.selection import played_source, selected_subject


def keep_card(action: bpy.types.Action, report: dict[str, Any]) -> None:
    """Store the card, which is origin, steps and figures, in an action."""
    store_json(action, FIX_CARD, report)


def stored_card(action: bpy.types.Action) -> Mapping[str, Any]:
    """Return the card in an action, which users may have edited; empty if there is none."""
    return load_json(action, FIX_CARD, dict)


def shown_card(context: bpy.types.Context) -> Mapping[str, Any]:
    """Return the card of what the selection plays; empty if it has none."""
    action = _played_action(context)
    card = {} if action is None else stored_card(action)
    is_complete = all(
        isinstance(card.get(name), kind)
        for name, kind in (("before", dict), ("after", dict), ("steps", list))
    )
    return card if is_complete else {}


def why_not_accept(context: bpy.types.Context) -> str:
    """Return why there is no result to accept, or an empty text."""
    if not shown_card(context):
        return "Press Fix My Take first."
    action = _played_action(context)
    is_linked = action is not None and action.library is not None
    return "The action is linked from another file." if is_linked else ""


def accept(context: bpy.types.Context) -> str:
    """Close the card; the result stays."""
    action = _played_action(context)
    if reason := why_not_accept(context):
        raise InvalidMotionError(reason)
    assert action is not None
    del action[FIX_CARD]
    return f"Accepted {action.name}."


def _played_action(context: bpy.types.Context) -> bpy.types.Action | None:
    subject = selected_subject(context)
    if subject is None:
        return None
    try:
        return played_source(subject)[0]
    except InvalidMotionError:
        return None
