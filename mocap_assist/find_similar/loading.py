"""Load a match as an action of the active armature, or as a strip of its NLA."""

from functools import partial

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.errors import InvalidMotionError
from ...solvers.retargeting import RootMotion
from ...solvers.rotations import inverse, rotate
from ..actions.action_write import write_action
from ..actions.armature_write import Output, check_writable
from ..blender import compat
from ..blender.stored_json import store_json
from ..library.button_settings import ClipPart, LoadBundle, LoadChoices
from ..library.solve_fetching import Fetched, FetchProblem, fetch_clip
from ..library.sources import background_blender
from ..retarget.solve_retargeting import Start
from ..rigs.target_read import find_roles, read_target, vertical_part
from ..runtime.selection import selected_armature
from ..runtime.subject import check_unchanged
from ..scene.rig import placement_of
from ..scene.scene_rate import scene_rate
from . import searches
from .nla import add_strip
from .searches import Search
from .solve_finding import Found

CLIP = "mocap_assist_clip"
"""Custom property of actions that were made of a clip: where it came from."""


def why_not_load(context: bpy.types.Context) -> str:
    """Return why no clip can be appended to an armature, or an empty text."""
    armature = selected_armature(context)
    if armature is None:
        return "Select the armature that receives the motion of the clip."
    if reason := searches.why_none(context):
        return reason
    try:
        check_writable(armature)
    except InvalidMotionError as error:
        return str(error)
    return ""


def read_loading(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LoadBundle
) -> "partial[Fetched]":
    """Read the armature's rig; return the picklable solve."""
    search, found = searches.chosen_match(bpy.context)
    problem, _ = problem_of(scene, armature, settings.choices, search, found)
    return partial(fetch_clip, problem)


def write_loaded(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: LoadBundle,
    fetched: Fetched,
    solved_digest: str | None = None,
) -> str:
    """Write the clip as a new action and assign it; return a message."""
    search, found = searches.chosen_match(bpy.context)
    problem, switches = problem_of(scene, armature, settings.choices, search, found)
    check_unchanged(armature, solved_digest, problem)
    check_writable(armature)
    frames = first_frame(search, found) + np.arange(fetched.n_frames, dtype=np.float64)
    name = f"{found.entry.name.rpartition('/')[2]}.{armature.name}"
    action, slot = write_action(armature, name, frames, fetched.keys, switches)
    note_clip(action, found)
    if settings.choices.result_as is Output.ACTION:
        compat.assign(armature, action, slot)
    else:
        add_strip(armature, action, slot, scene.frame_current, time_scale(search, found))
    return (
        f"{action.name}: {fetched.n_frames} frames of {found.entry.name} for {armature.name}."
    )


def note_clip(action: bpy.types.Action, found: Found) -> None:
    """Store in an action the clip that it was made from."""
    origin, frames = found.entry.origin, found.match.frames
    noted = {
        "clip": found.entry.name,
        "file": origin.path if origin else "",
        "item": origin.item if origin else "",
        "frames": [frames.start, frames.stop],
        "score": round(found.match.score, 4),
        "tags": list(found.entry.tags),
    }
    store_json(action, CLIP, noted)


def first_frame(search: Search, found: Found) -> float:
    """Return the integer scene frame where the matching segment begins."""
    return float(round(search.scene_frame(float(found.pairs[0, 0]))))


def time_scale(search: Search, found: Found) -> float:
    """Return the duration of the query relative to that of the matched part of the clip."""
    (query_first, clip_first), (query_last, clip_last) = found.pairs[[0, -1]]
    query = (query_last - query_first) / search.finding.stage.frame_rate
    clip = (clip_last - clip_first) / found.entry.frame_rate
    return float(query / clip) if query > 0.0 and clip > 0.0 else 1.0


def problem_of(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    choices: LoadChoices,
    search: Search,
    found: Found,
) -> tuple[FetchProblem, dict[tuple[str, str], float]]:
    """Return the solve that retargets a match to an armature, and the rig's switches."""
    if found.entry.origin is None:
        raise InvalidMotionError(
            f"The source file of {found.entry.name} is unknown. Build the library again."
        )
    retargeting = scene.mocap_assist.retarget.settings()
    settings = retargeting.retargeting
    on_root = settings.root_motion is RootMotion.ROOT_BONE
    limbs = retargeting.choices.limbs
    rig, switches = read_target(scene, armature, find_roles(armature), limbs, on_root)
    problem = FetchProblem(
        origin=found.entry.origin,
        frames=found.match.frames if choices.part is ClipPart.MATCH else None,
        frame_rate=scene_rate(scene),
        start=_start(armature, search, found) if choices.at_query else None,
        target=rig,
        settings=settings,
        blender=background_blender(scene.mocap_assist.library.rig_file),
    )
    return problem, dict(switches)


def _start(armature: bpy.types.Object, search: Search, found: Found) -> Start:
    """Return the initial position and heading of the query relative to the armature."""
    stage, first = search.finding.stage, found.pairs[0, 0]
    rotation, origin, _ = placement_of(armature.matrix_world, armature.name)
    about = vertical_part(rotation)
    position: NDArray[np.float64] = stage.positions[first] - search.meters * origin
    angle = 2.0 * np.arctan2(about[3], about[0])
    local = rotate(inverse(about), position)
    return Start(local[:2], float(stage.headings[first] - angle))
