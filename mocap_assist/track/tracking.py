"""Track: read the scene and add the tracked armature."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import ForegroundSettings
from ...solvers.depth_tracking.body import scene_from_camera
from ...solvers.depth_tracking.capturing import CaptureSettings, check_default_method
from ...solvers.depth_tracking.several_cameras import AlignmentSettings
from ...solvers.errors import MocapAssistError
from ...solvers.motion import Motion
from ...solvers.settings import Settings, setting
from ...solvers.version import version
from ..actions.armature_build import build_armature
from ..actions.armature_write import SUFFIX
from ..actions.new_action import write_motion
from ..actions.reliability_curves import write_reliability
from ..blender.stored_json import store_json
from ..depth.depth_preview import Shown, problem_of, recording_of, shows_depth
from ..jobs.protocol import PreviewSolve
from ..runtime.subject import check_unchanged
from ..scene import history
from ..scene.scene_objects import undo_on_error
from ..scene.units import unit_of
from .live_body import LiveBody, stage_of_preview
from .low_confidence import list_low_confidence
from .other_cameras import (
    camera_entries,
    check_others,
    place_cameras,
    read_again,
    read_cameras,
    scene_from_first_camera,
)
from .solve_cameras import track_cameras
from .solve_tracking import Tracked, mean_cm, partial_result, track_recording
from .tracked_armature.body import TrackedBody
from .tracked_armature.curves import write_residual

MODE = "QUATERNION"
CAPTURED = "mocap_assist_captured"
"""Custom property of the action: its origin as JSON. Clean treats it as raw."""


@dataclass(frozen=True, kw_only=True)
class FeetChoices(Settings):
    """Steps after tracking one person."""

    plant_feet: bool = setting(
        True, "Keep planted feet from sliding, where the recording shows feet"
    )


@dataclass(frozen=True, kw_only=True)
class TrackChoices(FeetChoices):
    """Steps after tracking."""

    all_people: bool = setting(
        False,
        "Track all visible people together; creates an armature for each",
        label="All People",
    )
    other_cameras: bool = setting(
        False,
        "Join the other selected recordings, of the same take by other depth cameras",
        label="Other Cameras",
    )


@dataclass(frozen=True, kw_only=True)
class WatchChoices(Settings):
    """Preview during a solve."""

    watch: bool = setting(
        True,
        "Draw the tracked body and follow its frame; unkeyed changes to other objects are lost",
        label="Live Preview",
    )


@dataclass(frozen=True, kw_only=True)
class EscChoices(Settings):
    """Result of a cancelled solve."""

    keep_on_esc: bool = setting(
        False,
        "On Esc, create an armature from the frames tracked so far",
        label="Keep Partial Result",
    )


class TrackBundle(NamedTuple):
    """Settings of the button."""

    choices: TrackChoices
    tracking: CaptureSettings
    actor: ForegroundSettings
    planting: PlantSettings
    watching: WatchChoices = WatchChoices()
    escaping: EscChoices = EscChoices()
    alignment: AlignmentSettings = AlignmentSettings()


class FixedMotion(NamedTuple):
    """A motion made from the tracked one, and its entry for the action's history."""

    motion: Motion
    entry: dict[str, Any]


def selected_preview(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it shows a depth recording."""
    active = context.view_layer.objects.active
    return active if active is not None and shows_depth(active) else None


def why_not_show(context: bpy.types.Context) -> str:
    """Return why there is no depth recording to show, or an empty text."""
    return "" if selected_preview(context) else "Select the points of a depth recording."


def why_not_track(context: bpy.types.Context) -> str:
    """Return why Track cannot use the selection with its settings, or an empty text."""
    if reason := why_not_use(context):
        return reason
    try:
        _check(selected_preview(context), context.scene.mocap_assist.track.settings())
    except MocapAssistError as error:
        return str(error)
    return ""


def why_not_use(context: bpy.types.Context) -> str:
    """Return why the selected points cannot be tracked, or an empty text."""
    preview = selected_preview(context)
    if preview is None:
        return "Select the points of an imported depth recording."
    return problem_of(preview)


def read_tracking(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> PreviewSolve[Tracked]:
    """Open the displayed recording; return the picklable solve."""
    _check(preview, settings)
    planting = settings.planting if settings.choices.plant_feet else None
    if settings.choices.other_cameras:
        return PreviewSolve(
            track_cameras, read_cameras(preview), settings.tracking, settings.actor, planting,
            settings.alignment,
        )  # fmt: skip
    recording = recording_of(preview.data)
    return PreviewSolve(
        track_recording, recording, settings.tracking, settings.actor, planting,
        settings.choices.all_people,
    )  # fmt: skip


def _check(preview: bpy.types.Object, settings: TrackBundle) -> None:
    """Raise MocapAssistError if the settings contradict each other or the selection."""
    choices = settings.choices
    if choices.all_people or choices.other_cameras:
        check_default_method(settings.tracking.method)
    if choices.other_cameras:
        check_others(preview, all_people=choices.all_people)


def watch_tracking(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> LiveBody | None:
    """Return the view of the body during tracking, if *Live Preview* is on."""
    return LiveBody(scene, stage_of_preview) if settings.watching.watch else None


def rescue_partial(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> Callable[[list[Any]], Tracked] | None:
    """Return a function that builds the partial result on Esc, if that is enabled."""
    if not settings.escaping.keep_on_esc:
        return None
    return partial(
        partial_result,
        recording=recording_of(preview.data),
        settings=settings.tracking,
    )


def write_tracked(
    scene: bpy.types.Scene,
    preview: bpy.types.Object,
    settings: TrackBundle,
    result: Tracked,
    solved_digest: str | None = None,
    fixed: FixedMotion | None = None,
) -> str:
    """Add an armature for each actor over the points; return a message.

    The armature of the first actor becomes active. If that motion was `fixed`, the armature
    plays it; the tracked action is its recorded one.

    Raises InvalidMotionError if the points show another recording than the one that was solved.
    """
    shown: Any = recording_of(preview.data)
    if result.other_numbers:
        shown = read_again(preview, result.other_numbers)
    check_unchanged(preview, solved_digest, shown)
    with undo_on_error(bpy.context):
        others = [
            add_armature(scene, preview, settings, other) for other in reversed(result.others)
        ]
        first = add_armature(scene, preview, settings, result, fixed)
        moved = place_cameras(scene, preview, result)
    return " ".join([first, *reversed(others), *moved])


def add_armature(
    scene: bpy.types.Scene,
    preview: bpy.types.Object,
    settings: TrackBundle,
    result: Tracked,
    fixed: FixedMotion | None = None,
    *,
    origin: Mapping[str, Any] = {"operation": "track_depth"},
) -> str:
    """Add the armature of one actor over the points; return a message.

    The action stores the `origin`, next to settings and figures.
    """
    shown, context, meters_per_unit = Shown.read(preview.data), bpy.context, unit_of(scene)
    image_indices = result.images_per_frame * (result.first + np.arange(result.motion.n_frames))
    frames = shown.start + shown.step * image_indices
    name = f"{preview.name} tracked"
    if result.person is not None:
        name = f"{name} person {result.person + 1}"
    armature, bones = build_armature(
        context, name, result.motion.skeleton, meters_per_unit, MODE
    )
    source = write_motion(armature, bones, result.motion, frames, meters_per_unit)
    if fixed is not None:
        name = source[0].name + SUFFIX
        played, _ = write_motion(
            armature, bones, fixed.motion, frames, meters_per_unit, name=name
        )
        played.use_fake_user = True
        history.record(played, source, fixed.entry)
    armature.matrix_world = _scene_from_motion(preview, result) @ Matrix.Scale(
        meters_per_unit, 4
    )
    armature.show_in_front = True
    write_reliability(armature, *source, frames, result.confidence)
    write_residual(armature, source, frames, result.residual)
    body = TrackedBody(result.body, shown, result.floor, settings.actor, result.person)
    body.write(armature, dict(zip(result.motion.skeleton.names, bones, strict=True)))
    action = source[0]
    store_json(action, CAPTURED, {**origin, **_entry(settings, result, shown)})
    list_low_confidence(scene, action, frames, result.low_confidence, _report(result))
    return f"{armature.name}: {_report(result)}"


def _scene_from_motion(preview: bpy.types.Object, result: Tracked) -> Matrix:
    """Return the transform (4, 4) from the motion to the scene, where the points are."""
    camera_from_motion = Matrix(np.linalg.inv(scene_from_camera(result.floor)).tolist())
    return scene_from_first_camera(preview, result) @ camera_from_motion


def _report(result: Tracked) -> str:
    mean = mean_cm(result.residual)
    distance = "" if mean is None else f" Mean distance from the points {mean:.1f} cm."
    n_restarts, n_ranges = len(result.restarts), len(result.low_confidence)
    redetected = f" Redetected {n_restarts} times." if n_restarts else ""
    ranges = {0: "No low-confidence ranges.", 1: "1 low-confidence range."}.get(
        n_ranges, f"{n_ranges} low-confidence ranges."
    )
    summary = f"{result.motion.n_frames} frames.{distance}{redetected} {ranges}"
    return " ".join([summary, *result.remarks])


def _entry(settings: TrackBundle, result: Tracked, shown: Shown) -> dict[str, object]:
    used = [settings.choices, settings.tracking, settings.actor, settings.planting]
    if result.cameras:
        used.append(settings.alignment)
    return {
        "version": version(),
        "settings": history.json_ready(*used),
        "recording": shown.path,
        "mean_residual_cm": mean_cm(result.residual),
        "coverage": result.coverage,
        "restarts": list(result.restarts),
        "doubtful_ranges": len(result.low_confidence),
        "cameras": camera_entries(result.cameras),
    }
