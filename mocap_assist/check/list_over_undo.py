"""Keep the list of issues from pointing to an action that an undo step frees.

A quiet check adds no undo step. Undo reuses a scene that is the same in two steps, with what
its properties point to by then: that may be the action of a result that undo removes.
"""

import bpy
from bpy.app import handlers

_names: dict[str, str] = {}
"""Name of the checked action of each scene, during an undo step."""


@handlers.persistent
def forget(*_: object) -> None:
    """Point to no action, before an undo step."""
    _names.clear()
    for scene in bpy.data.scenes:
        action = scene.mocap_assist.checked_action
        if action is not None:
            _names[scene.name] = action.name
            scene.mocap_assist.checked_action = None


@handlers.persistent
def recall(*_: object) -> None:
    """Point to the action again, after it, in scenes that were reused, if it still exists."""
    for name, action in _names.items():
        scene = bpy.data.scenes.get(name)
        if scene is not None and scene.mocap_assist.checked_action is None:
            scene.mocap_assist.checked_action = bpy.data.actions.get(action)
    _names.clear()


def register() -> None:
    """Do so at each undo and redo."""
    for steps in (handlers.undo_pre, handlers.redo_pre):
        steps.append(forget)
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.append(recall)


def unregister() -> None:
    """Remove the handlers."""
    for steps in (handlers.undo_pre, handlers.redo_pre):
        steps.remove(forget)
    for steps in (handlers.undo_post, handlers.redo_post):
        steps.remove(recall)
