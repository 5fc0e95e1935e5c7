"""Fix My Take: read the scene and write the result."""

from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import bpy

from ...solvers.denoising import DenoiseSettings, PlantSettings
from ...solvers.markers import SolveSettings
from ...solvers.motion import JointLimits, Tracks
from ...solvers.reconstruction import ReconstructSettings
from ...solvers.workflows import (
    UNKNOWN,
    FixSettings,
    MarkerMotion,
    MarkerMotionSettings,
    TakeOrigin,
    figure_texts,
    find_origin,
)
from ..actions.armature_read import read_take
from ..actions.limits import has_limits, read_limits
from ..blender.time_slices import Sliced, Steps
from ..check.checking import list_issues, read_played
from ..clean.button_settings import CleanBundle, CleanChoices
from ..clean.cleaning import read_cleaning, write_cleaned
from ..clean.solve_cleaning import Cleaned
from ..markers.solving import SolveBundle, read_solving, write_solved
from ..panels.fix_card import keep_card
from ..reconstruct.button_settings import ReconstructBundle, ReconstructChoices
from ..reconstruct.reconstructing import read_reconstructing, write_reconstructed
from ..reconstruct.solve_reconstructing import Rebuilt
from ..runtime.selection import played_source, selected_armature, why_not_clean
from ..runtime.subject import Subject
from ..scene import history
from ..scene.origin import was_tracked
from ..track.tracking import selected_preview
from .solve_fixing import Fixed, fix

DEPTH = "This is a depth recording. Press Track, then Fix My Take on the armature."
CLEAN = CleanBundle(CleanChoices(), DenoiseSettings(), PlantSettings())
RECONSTRUCT = ReconstructBundle(ReconstructChoices(), ReconstructSettings(), PlantSettings())
SOLVE = SolveBundle(MarkerMotionSettings(), SolveSettings())
"""Settings of the buttons whose steps run: their defaults."""


class FixBundle(NamedTuple):
    """Settings of the button."""

    fixing: FixSettings


def why_not_fix(context: bpy.types.Context) -> str:
    """Return why the selection cannot be fixed, or an empty text."""
    if selected_preview(context) is not None:
        return DEPTH
    return why_not_clean(context)


@Sliced
def read_fixing(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: FixBundle
) -> "Steps[partial[Fixed]]":
    """Read what an armature or markers play; return the picklable solve."""
    here = Subject.of(scene, subject)
    if subject.type != "ARMATURE":
        solve = yield from read_solving.steps(scene, subject, SOLVE)
        tracks: Tracks = solve.args[0]
        if find_origin(tracks) is TakeOrigin.MARKERS:
            return partial(fix, tracks, settings.fixing)
        cleaning = yield from read_cleaning.steps(*here.find(), CLEAN)
        return partial(fix, cleaning.args[0], settings.fixing)
    if _is_from_camera(subject):
        rebuilding = yield from read_reconstructing.steps(scene, subject, RECONSTRUCT)
        problem, finish = rebuilding.args[:2]
        return partial(fix, problem, settings.fixing, contacts=finish.contacts)
    cleaning = yield from read_cleaning.steps(scene, subject, CLEAN)
    problem, finish = cleaning.args[:2]
    limits = yield from _limits_of(here)
    return partial(fix, problem, settings.fixing, contacts=finish.contacts, limits=limits)


@Sliced
def write_fixed(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    settings: FixBundle,
    fixed: Fixed,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Write the result as the button of its step does, list its issues and keep its card.

    Raises InvalidMotionError if the subject plays another motion than the one that was solved.
    """
    here = Subject.of(scene, subject)
    written, plant_feet = fixed.written, settings.fixing.plant_feet
    if isinstance(written, Cleaned):
        choices = CLEAN._replace(choices=replace(CLEAN.choices, plant_feet=plant_feet))
        yield from write_cleaned.steps(scene, subject, choices, written, solved_digest)
    elif isinstance(written, Rebuilt):
        rebuilding = RECONSTRUCT._replace(
            choices=replace(RECONSTRUCT.choices, plant_feet=plant_feet)
        )
        yield from write_reconstructed.steps(scene, subject, rebuilding, written, solved_digest)
    else:
        yield from write_solved.steps(scene, subject, SOLVE, written, solved_digest)
    scene, subject = here.find()
    here = Subject.of(scene, fixed_subject(subject, fixed))
    scene, subject = here.find()
    take = yield from read_played.steps(scene, subject)
    scene, subject = here.find()
    list_issues(scene, subject, take.frames, fixed.issues, fixed.quality)
    action, _ = played_source(subject)
    keep_card(action, fixed.report)
    return f"{action.name}: {_summary(fixed.report)}."


def fixed_subject(subject: bpy.types.Object, fixed: Fixed) -> bpy.types.Object:
    """Return what plays the result: the subject, or the new armature made of its markers."""
    if not isinstance(fixed.written, MarkerMotion):
        return subject
    armature = selected_armature(bpy.context)
    assert armature is not None
    return armature


def _limits_of(here: Subject) -> Steps[JointLimits | None]:
    """Return the limits of the rig, which Check looks at, too."""
    scene, armature = here.find()
    if not has_limits(armature):
        return None
    take = yield from read_take.steps(armature, scene, source=played_source(armature))
    return read_limits(here.find()[1], take, take.rig.bones)


def _is_from_camera(armature: bpy.types.Object) -> bool:
    """Whether the joints of a depth camera were recorded."""
    played = played_source(armature)
    recorded = history.raw_of(played[0]) or played
    return was_tracked(recorded[0])


def _summary(report: dict[str, Any]) -> str:
    """Return the figures that are known in one line."""
    rows = figure_texts(report["before"], report["after"])
    return "; ".join(
        f"{label.lower()} {before} → {after}"
        for label, before, after in rows
        if UNKNOWN not in {before, after}
    )
