"""Link or append the original action of a match from its .blend file."""

from pathlib import Path

import bpy

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ..actions.fitting import fitting_slots
from ..blender import compat
from ..jobs.in_blender import BLEND
from ..runtime.selection import selected_armature
from . import searches
from .solve_finding import Found


def why_not_link(context: bpy.types.Context) -> str:
    """Return why no action can be linked, or an empty text."""
    if reason := searches.why_none(context):
        return reason
    _, found = searches.chosen_match(context)
    if not is_action(found):
        return f"{found.entry.name} is a recording, not an action of a .blend file. Append it."
    return ""


def is_action(found: Found) -> bool:
    """Whether a match is an action of a .blend file."""
    origin = found.entry.origin
    return origin is not None and origin.path.endswith(BLEND)


def take_chosen(context: bpy.types.Context, link: bool) -> str:
    """Link or append the chosen action; let the armature play it if it has its bones.

    Returns a sentence about it; raises MocapAssistError where that is impossible.
    """
    _, found = searches.chosen_match(context)
    action = take_action(found, link)
    armature = selected_armature(context)
    slots = fitting_slots(armature, action) if armature is not None else []
    if armature is None or not slots or armature.library is not None:
        if link:
            return f"{action.name} was linked; no selected armature has its bones."
        return f"{action.name} was appended; no selected armature has its bones."
    compat.assign(armature, action, slots[0])
    if link:
        return f"{action.name} was linked and assigned to {armature.name}."
    return f"{action.name} was appended and assigned to {armature.name}."


def take_action(found: Found, link: bool) -> bpy.types.Action:
    """Return the action of a match, brought into this file if it is not there yet.

    Raises
    ------
    InvalidMotionError
        The match is no action of a .blend file.
    InvalidFileError
        The file has gone, cannot be read, or has the action no more.
    """
    origin = found.entry.origin
    if origin is None or not is_action(found):
        raise InvalidMotionError(f"{found.entry.name} is not an action of a .blend file.")
    path = Path(origin.path)
    if bpy.data.filepath and Path(bpy.data.filepath).resolve() == path:
        here = [each for each in bpy.data.actions if each.library is None]
        return _find_action(here, origin.item, path)
    if not path.is_file():
        raise InvalidFileError(f"{path} was moved or deleted; its actions cannot be loaded.")
    try:
        with bpy.data.libraries.load(str(path), link=link) as (there, taken):
            name = _name_in(there.actions, origin.item, path)
            taken.actions = [name]
    except OSError as error:
        raise InvalidFileError(f"{path} cannot be read: {error}") from None
    action: bpy.types.Action = taken.actions[0]
    if not link:
        action.use_fake_user = True
    return action


def fits_any_armature(scene: bpy.types.Scene, source: bpy.types.Action) -> bool:
    """Whether any armature of the scene has the bones of an action."""
    return any(
        each.type == "ARMATURE" and fitting_slots(each, source) for each in scene.objects
    )


def _find_action(actions: list[bpy.types.Action], item: str, path: Path) -> bpy.types.Action:
    name = _name_in([each.name for each in actions], item, path)
    return next(each for each in actions if each.name == name)


def _name_in(names: list[str], item: str, path: Path) -> str:
    """Return the action's name: the item's name, without that of the slot."""
    for name in (item, item.rpartition(":")[0]):
        if name in names:
            return name
    raise InvalidFileError(f"{path} no longer has the action {item}. Build the library again.")
