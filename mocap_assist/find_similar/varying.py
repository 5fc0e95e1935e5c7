"""Use matches as examples of Vary: from a take to a crowd through its library."""

from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.errors import InvalidMotionError
from ..actions.action_write import write_action
from ..actions.armature_write import check_writable
from ..blender.name_lists import SEPARATOR, join_names
from ..library.button_settings import LoadChoices, UseBundle
from ..library.solve_fetching import FetchedClips, FetchProblems, fetch_clips
from ..runtime.subject import check_unchanged
from . import searches
from .loading import note_clip, problem_of, why_not_load
from .solve_finding import Found

FIRST_FRAME = 1.0
"""Scene frame at which the clips begin."""


class _MatchesToVary(NamedTuple):
    found: tuple[Found, ...]
    switches: dict[tuple[str, str], float]
    problems: FetchProblems


why_not_use = why_not_load


def read_best(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: UseBundle
) -> "partial[FetchedClips]":
    """Read the armature's rig; return the picklable solve."""
    return partial(fetch_clips, _read(scene, armature, settings).problems)


def write_best(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: UseBundle,
    fetched: FetchedClips,
    solved_digest: str | None = None,
) -> str:
    """Write the best matches as actions and tick them, and no others, for Vary.

    Returns a sentence about it.
    """
    reading = _read(scene, armature, settings)
    check_unchanged(armature, solved_digest, reading.problems)
    check_writable(armature)
    names = []
    for found, clip in zip(reading.found, fetched.clips, strict=True):
        if clip is None:
            continue
        frames = FIRST_FRAME + np.arange(clip.n_frames, dtype=np.float64)
        name = f"{_short_name(found)}.{armature.name}".replace(SEPARATOR, ",")
        action, _ = write_action(armature, name, frames, clip.keys, reading.switches)
        note_clip(action, found)
        names.append(action.name)
    scene.mocap_assist.vary.actions = join_names(names)
    clips = "1 library clip" if len(names) == 1 else f"{len(names)} library clips"
    message = f"Vary now uses {clips} as examples."
    if n_missing := len(reading.found) - len(names):
        message += f" {n_missing} could not be loaded: {fetched.trouble}"
    return message


def _read(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: UseBundle
) -> _MatchesToVary:
    search = searches.ranked_search(bpy.context)
    usable = [each for each in search.finding.found if each.entry.origin is not None]
    best = tuple(usable[: settings.choices.n_best])
    if not best:
        raise InvalidMotionError(
            "The source files of these clips are unknown. Build the library again."
        )
    taken = LoadChoices(part=scene.mocap_assist.load.settings().choices.part)
    pairs = [problem_of(scene, armature, taken, search, found) for found in best]
    problems = FetchProblems(
        tuple(problem for problem, _ in pairs), tuple(map(_short_name, best))
    )
    return _MatchesToVary(best, pairs[0][1], problems)


def _short_name(found: Found) -> str:
    return found.entry.name.rpartition("/")[2]
