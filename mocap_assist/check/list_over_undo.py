"""Keep the list of issues true when undo or redo changes what is played.

A check adds no undo step. So undo brings back the list of an older check, or none at all, or
reuses a scene that is the same in two steps, with a list and a pointer of a later step. Such a
pointer may be to the action of a result that undo frees.
"""

from typing import Any, NamedTuple

import bpy
from bpy.app import handlers

from ..runtime.selection import selected_subject
from .renewing import renew_always
from .scene_checking import is_stale

FIELDS = "name", "start", "stop", "kind", "severity", "sentence"
"""Properties of an issue."""


class _List(NamedTuple):
    """What Check shows in a scene; numbers of the session survive undo, pointers do not."""

    action: int
    """Number of the checked action; 0 for none."""
    report: str
    active_issue: int
    issues: tuple[dict[str, Any], ...]


_lists: dict[int, _List] = {}
"""By the number of the scene, during an undo step; of scenes where Check was pressed."""


@handlers.persistent
def remember_lists(*_: object) -> None:
    """Remember all lists before an undo step, and point to no action."""
    _lists.clear()
    for scene in bpy.data.scenes:
        shown = scene.mocap_assist
        action = shown.checked_action
        if shown.report:
            _lists[scene.session_uid] = _List(
                0 if action is None else action.session_uid,
                shown.report,
                shown.active_issue,
                tuple(
                    {name: getattr(issue, name) for name in FIELDS} for issue in shown.issues
                ),
            )
        if action is not None:
            shown.checked_action = None


@handlers.persistent
def show_remembered_list(*_: object) -> None:
    """Show the list of what is played, if it is known, after it; then check again.

    Undo may also have changed keys of an action that is still played. Only the scene of the
    window is checked.
    """
    numbers = {each.session_uid: each for each in bpy.data.actions}
    for scene in bpy.data.scenes:
        kept = _lists.get(scene.session_uid)
        if kept is None:
            continue
        shown = scene.mocap_assist
        is_in_window = scene == bpy.context.scene
        subject = selected_subject(bpy.context) if is_in_window else None
        if subject is None or is_stale(shown.checked_action, subject):
            _show(shown, kept, numbers.get(kept.action))
        if is_in_window:
            renew_always(scene)
    _lists.clear()


def _show(shown: bpy.types.PropertyGroup, kept: _List, action: bpy.types.Action | None) -> None:
    """Show a list of before; without its action it only says that Check was pressed."""
    shown.checked_action, shown.report = action, kept.report
    shown.issues.clear()
    shown.active_issue = 0
    if action is None:
        return
    for values in kept.issues:
        issue = shown.issues.add()
        for name, value in values.items():
            setattr(issue, name, value)
    shown.active_issue = kept.active_issue


def register() -> None:
    """Do so at each undo and redo."""
    for steps in (handlers.undo_pre, handlers.redo_pre):
        steps.append(remember_lists)
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.append(show_remembered_list)


def unregister() -> None:
    """Remove the handlers."""
    for steps in (handlers.undo_pre, handlers.redo_pre):
        steps.remove(remember_lists)
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.remove(show_remembered_list)
