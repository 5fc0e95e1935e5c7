"""Read markers for the button Make Skeleton, and add its armature."""

from functools import partial
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.errors import InvalidMotionError
from ...solvers.markers import SolveSettings
from ...solvers.workflows import MarkerMotion, MarkerMotionSettings, motion_from_markers
from ..actions.armature_build import build_armature
from ..actions.markers.take import read_markers
from ..actions.new_action import write_motion
from ..blender.time_slices import Sliced, Steps
from ..runtime.selection import played_source, selected_subject
from ..runtime.subject import Subject, check_unchanged
from ..scene import history
from ..scene.origin import ORIGIN
from ..scene.scene_objects import undo_on_error
from ..scene.units import unit_of

MODE = "QUATERNION"


class SolveBundle(NamedTuple):
    """Settings of the button."""

    steps: MarkerMotionSettings
    solving: SolveSettings


def why_not_solve(context: bpy.types.Context) -> str:
    """Return why no skeleton can be created, or an empty text."""
    subject = selected_subject(context)
    if subject is None or subject.type == "ARMATURE":
        return "Select a marker set."
    try:
        played_source(subject)
    except InvalidMotionError as error:
        return str(error)
    return ""


@Sliced
def read_solving(
    scene: bpy.types.Scene, holder: bpy.types.Object, settings: SolveBundle
) -> "Steps[partial[MarkerMotion]]":
    """Read what the markers play; return the picklable solve."""
    take = yield from read_markers.steps(holder, scene)
    return partial(
        motion_from_markers, take.tracks, settings=settings.steps, solving=settings.solving
    )


@Sliced
def write_solved(
    scene: bpy.types.Scene,
    holder: bpy.types.Object,
    settings: SolveBundle,
    result: MarkerMotion,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Add an armature that moves as the markers do; return a sentence about it.

    Raises InvalidMotionError if the markers play another motion than the one that was solved.
    """
    here = Subject.of(scene, holder)
    take = yield from read_markers.steps(holder, scene)
    scene, holder = here.find()
    yield from check_unchanged.steps(holder, solved_digest, take.tracks)
    scene, holder = here.find()
    context, meters_per_unit = bpy.context, unit_of(scene)
    with undo_on_error(context):
        name = f"{holder.name} skeleton"
        armature, bones = build_armature(
            context, name, result.motion.skeleton, meters_per_unit, MODE
        )
        action, _ = write_motion(armature, bones, result.motion, take.frames, meters_per_unit)
    history.record(action, played_source(holder), _entry(settings, result), of_another_rig=True)
    for owner in (armature, action):
        if ORIGIN in holder:
            owner[ORIGIN] = holder[ORIGIN]
    return f"{armature.name}: {_report(result)}"


def _report(result: MarkerMotion) -> str:
    error = 1000.0 * np.nanmean(result.solved.error)
    n_joints = sum(not name.endswith("_end") for name in result.motion.skeleton.names)
    n_markers, its_set = len(result.solved.markers), result.solved.marker_set.name
    message = (
        f"{n_joints} joints from {n_markers} markers ({its_set}), mean marker error"
        f" {error:.1f} mm."
    )
    if result.swaps:
        message += f" Fixed {len(result.swaps)} swapped labels."
    return message


def _entry(settings: SolveBundle, result: MarkerMotion) -> dict[str, object]:
    return {
        "operation": "solve_skeleton",
        "settings": history.json_ready(*settings),
        "marker_set": result.solved.marker_set.name,
        "mean_error_mm": float(1000.0 * np.nanmean(result.solved.error)),
        "swaps": [[*swap.names, swap.frames.start, swap.frames.stop] for swap in result.swaps],
    }
