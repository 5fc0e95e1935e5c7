"""Matches as what Clean and Reconstruct learn from: the loop from a take to its library."""

from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ..blender.name_lists import SEPARATOR, join_names
from ..clean.button_settings import Prior
from ..reconstruct.button_settings import Postures
from . import searches
from .linking import fits_any_armature, is_action, take_action
from .solve_finding import Found

CLEAN, RECONSTRUCT = "clean", "reconstruct"


def learn_from_best(context: bpy.types.Context, group: str, n_best: int) -> str:
    """Replace the list of examples by the best matches.

    Returns a sentence about it; raises InvalidMotionError where no search found anything.
    """
    search = searches.ranked_search(context)
    best = search.finding.found[:n_best]
    usable = dict.fromkeys(entry for found in best if (entry := _example(context, found)))
    settings = getattr(context.scene.mocap_assist, group)
    settings.examples = join_names(usable)
    if group == CLEAN:
        settings.prior = Prior.EXAMPLES.name
    else:
        settings.postures = Postures.EXAMPLES.name
    message = f"{group.capitalize()} learns from {len(usable)} clips."
    if n_missing := len(best) - len(usable):
        message += (
            f" {n_missing} could not be loaded: the file is gone, or no rig here has its bones."
        )
    return message


def _example(context: bpy.types.Context, found: Found) -> str:
    """Return the entry of a match for the list of examples; nothing if it is unsuitable."""
    origin = found.entry.origin
    if origin is None or SEPARATOR in origin.path or not Path(origin.path).is_file():
        return ""
    if not is_action(found):
        return origin.path
    try:
        action = take_action(found, link=True)
    except MocapAssistError:
        return ""
    return action.name if fits_any_armature(context.scene, action) else ""
