"""Fix My Take: read the scene and write the result."""

from dataclasses import replace
from functools import partial
from typing import Any

import bpy

from ...solvers.arrays import Array
from ...solvers.denoising import DenoiseSettings, PlantSettings
from ...solvers.depth_scene import ForegroundSettings
from ...solvers.depth_tracking.capturing import CaptureSettings
from ...solvers.markers import SolveSettings
from ...solvers.motion import JointLimits, Tracks
from ...solvers.reconstruction import ReconstructSettings
from ...solvers.workflows import (
    UNKNOWN,
    FixedTake,
    MarkerMotion,
    MarkerMotionSettings,
    TakeOrigin,
    figure_texts,
    find_origin,
)
from ..actions.armature_read import read_take
from ..actions.contact_keys import write_contacts
from ..actions.limits import has_limits, read_limits
from ..blender.time_slices import Sliced, Steps
from ..check.scene_checking import list_issues, read_played
from ..clean.button_settings import CleanBundle, CleanChoices
from ..clean.scene_cleaning import read_cleaning, write_cleaned
from ..clean.solve_cleaning import Cleaned
from ..depth.depth_preview import recording_of, shows_depth
from ..jobs.protocol import PreviewSolve
from ..markers.scene_skeleton import SolveBundle, read_solving, write_solved
from ..panel_parts.fix_card import keep_card
from ..reconstruct.button_settings import ReconstructBundle, ReconstructChoices
from ..reconstruct.scene_reconstructing import read_reconstructing, write_reconstructed
from ..reconstruct.solve_reconstructing import Rebuilt
from ..retarget.scene_retargeting import target_called
from ..runtime.selection import (
    played_source,
    selected_armature,
    selected_subject,
    timeline_frames,
    why_not_clean,
)
from ..runtime.subject import Subject
from ..scene import history
from ..scene.origin import was_tracked
from ..track.live_body import LiveBody, stage_of_preview
from ..track.tracking import (
    FixedMotion,
    TrackBundle,
    TrackChoices,
    selected_preview,
    why_not_use,
    write_tracked,
)
from .button_settings import FixBundle
from .retargeting import retargeted
from .solve_fixing import Fixed, FixedDepth, fix

CLEAN = CleanBundle(CleanChoices(), DenoiseSettings(), PlantSettings())
RECONSTRUCT = ReconstructBundle(ReconstructChoices(), ReconstructSettings(), PlantSettings())
SOLVE_BUNDLE = SolveBundle(MarkerMotionSettings(), SolveSettings())
TRACK = TrackBundle(
    TrackChoices(plant_feet=False), CaptureSettings(), ForegroundSettings(), PlantSettings()
)
"""Settings of the buttons whose steps run: their defaults."""
SUMMARY = (
    "jitter {before} → {after}",
    "longest slide {before} → {after}",
    "spikes and gaps {before} → {after}",
    "issues {before} → {after}",
)
"""Texts of the four figures for the status bar."""


def selected_take(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the points of a depth recording, the armature or the parent of the markers."""
    return selected_preview(context) or selected_subject(context)


def why_not_fix(context: bpy.types.Context) -> str:
    """Return why the selection cannot be fixed, or an empty text."""
    if selected_preview(context) is not None:
        return why_not_use(context)
    return why_not_clean(context)


@Sliced
def read_fixing(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: FixBundle
) -> "Steps[partial[Fixed]]":
    """Read what an armature, markers or points of depth images show; return the solve."""
    here = Subject.of(scene, subject)
    if settings.choices.rig:
        target_called(scene, settings.choices.rig, subject)  # before any work
    if shows_depth(subject):
        return PreviewSolve(fix, recording_of(subject.data), settings.fixing)
    if subject.type != "ARMATURE":
        solve = yield from read_solving.steps(scene, subject, SOLVE_BUNDLE)
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


def watch_fixing(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: FixBundle
) -> LiveBody | None:
    """Return the view of the body in depth images, if *Live Preview* of Track is on."""
    is_shown = shows_depth(subject) and scene.mocap_assist.track.watch
    return LiveBody(scene, stage_of_preview) if is_shown else None


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
    elif isinstance(written, FixedDepth):
        entry = {"operation": "fix", "settings": history.json_ready(*settings)}
        _write_depth(scene, subject, written, entry, solved_digest)
    else:
        yield from write_solved.steps(scene, subject, SOLVE_BUNDLE, written, solved_digest)
    scene, subject = here.find()
    here = Subject.of(scene, fixed_subject(subject, fixed))
    scene, subject = here.find()
    take = yield from read_played.steps(scene, subject)
    scene, subject = here.find()
    _key_contacts(subject, take.frames, fixed)
    name = played_source(subject)[0].name
    report = _report(scene, subject, take.frames, fixed.take)  # Esc may end the retargeting
    if settings.choices.rig:
        try:
            report = yield from retargeted(here, settings.choices.rig, report)
        except GeneratorExit:  # Esc: Blender adds no undo step for a button that was cancelled
            push_undo(name)
            raise
        keep_card(played_source(here.find()[1])[0], report)
    return f"{name} was fixed: {_summary(report)}."


def _report(
    scene: bpy.types.Scene, subject: bpy.types.Object, frames: Array, fixed: FixedTake
) -> dict[str, Any]:
    """List the issues of a result, and keep its card, which is returned."""
    list_issues(scene, subject, frames, fixed.after.issues, fixed.after.quality)
    report = fixed.figures(timeline_frames(subject, frames))
    keep_card(played_source(subject)[0], report)
    return report


def push_undo(name: str) -> None:
    """Add an undo step after the fix of an action or take of that name."""
    if bpy.ops.ed.undo_push.poll():
        bpy.ops.ed.undo_push(message=f"Fix {name}")


def fixed_subject(subject: bpy.types.Object, fixed: Fixed) -> bpy.types.Object:
    """Return the object that plays the result: the subject, or a new armature."""
    if not isinstance(fixed.written, MarkerMotion | FixedDepth):
        return subject
    armature = selected_armature(bpy.context)
    assert armature is not None
    return armature


def _write_depth(
    scene: bpy.types.Scene,
    preview: bpy.types.Object,
    written: FixedDepth,
    entry: dict[str, Any],
    solved_digest: str | None,
) -> None:
    """Add the armature that Track makes."""
    fixed = FixedMotion(written.motion, entry)
    write_tracked(scene, preview, TRACK, written.tracked, solved_digest, fixed)


def _key_contacts(armature: bpy.types.Object, frames: Array, fixed: Fixed) -> None:
    """Key the contacts at which feet of a new armature were planted, as Clean does."""
    planted = fixed.take.chain.planted
    if planted is not None and isinstance(fixed.written, MarkerMotion | FixedDepth):
        source = played_source(armature)
        write_contacts(armature, *source, frames, planted.all_contacts, detected=True)


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
    return ", ".join(
        text.format(before=before, after=after)
        for text, (_, before, after) in zip(SUMMARY, rows, strict=True)
        if UNKNOWN not in {before, after}
    )
