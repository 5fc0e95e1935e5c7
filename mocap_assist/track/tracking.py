"""What the button Track reads from the scene, and the armature that it adds."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import Floor, ForegroundSettings
from ...solvers.depth_tracking.body import scene_from_camera
from ...solvers.depth_tracking.capturing import CaptureSettings
from ...solvers.settings import Settings, setting
from ...solvers.version import version
from ..actions.armature_build import build_armature
from ..actions.new_action import write_motion
from ..actions.reliability_curves import write_reliability
from ..blender.stored_json import store_json
from ..depth.depth_preview import KEY, Shown, problem_of, recording_of
from ..jobs.protocol import PreviewSolve
from ..runtime.subject import check_unchanged
from ..scene import history
from ..scene.scene_objects import all_or_nothing
from ..scene.units import unit_of
from .live_body import LiveBody, stage_of_preview
from .low_confidence import list_doubts
from .solve_tracking import Tracked, mean_cm, track_recording, tracked_so_far
from .tracked_body import TrackedBody
from .tracked_curves import write_residual

MODE = "QUATERNION"
CAPTURED = "mocap_assist_captured"
"""Custom property of the action: how it was made, as JSON. To Clean it is raw."""


@dataclass(frozen=True, kw_only=True)
class TrackChoices(Settings):
    """What is done besides tracking."""

    plant_feet: bool = setting(
        True, "Keep planted feet from sliding, where the recording shows feet"
    )


@dataclass(frozen=True, kw_only=True)
class WatchChoices(Settings):
    """What is done while somebody looks on."""

    watch: bool = setting(
        True,
        "Draw the body while tracking and follow in time; other objects' unkeyed changes are"
        " lost",
        label="Live Preview",
    )


@dataclass(frozen=True, kw_only=True)
class EscChoices(Settings):
    """What is left of a solve that is ended early."""

    keep_on_esc: bool = setting(
        False,
        "On Esc, create an armature from the frames tracked so far",
        label="Keep Partial Result",
    )


class TrackBundle(NamedTuple):
    """All that the button offers."""

    choices: TrackChoices
    tracking: CaptureSettings
    actor: ForegroundSettings
    planting: PlantSettings
    watching: WatchChoices = WatchChoices()
    escaping: EscChoices = EscChoices()


def selected_preview(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object if it shows a recording of depth."""
    active = context.view_layer.objects.active
    shows = active is not None and active.type == "MESH" and KEY in active.data
    return active if shows else None


def why_not_track(context: bpy.types.Context) -> str:
    """Return why nobody can be tracked, or nothing."""
    preview = selected_preview(context)
    if preview is None:
        return "Select the points of an imported depth recording."
    return problem_of(preview)


def read_tracking(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> PreviewSolve[Tracked]:
    """Open the recording that is shown; return what is to be solved, which may be pickled."""
    planting = settings.planting if settings.choices.plant_feet else None
    recording = recording_of(preview.data)
    return PreviewSolve(track_recording, recording, settings.tracking, settings.actor, planting)


def watch_tracking(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> LiveBody | None:
    """Return what shows the body while it is tracked, if that is wanted."""
    return LiveBody(scene, stage_of_preview) if settings.watching.watch else None


def keep_tracked(
    scene: bpy.types.Scene, preview: bpy.types.Object, settings: TrackBundle
) -> Callable[[list[Any]], Tracked] | None:
    """Return what makes the best of what was tracked until Esc, if that is wanted."""
    if not settings.escaping.keep_on_esc:
        return None
    recording = recording_of(preview.data)
    return partial(tracked_so_far, recording=recording, settings=settings.tracking)


def write_tracked(
    scene: bpy.types.Scene,
    preview: bpy.types.Object,
    settings: TrackBundle,
    result: Tracked,
    asked: str | None = None,
) -> str:
    """Add an armature that moves as the actor did, over the points; return a sentence.

    Raises InvalidMotionError if the points show something else than what was `asked`.
    """
    check_unchanged(preview, asked, recording_of(preview.data))
    shown, context, metres = Shown.read(preview.data), bpy.context, unit_of(scene)
    pictures = result.first + np.arange(result.motion.n_frames)
    frames = shown.start + shown.step * pictures
    with all_or_nothing(context):
        name = f"{preview.name} tracked"
        armature, bones = build_armature(context, name, result.motion.skeleton, metres, MODE)
        source = write_motion(armature, bones, result.motion, frames, metres)
        armature.matrix_world = _place(preview, result.floor) @ Matrix.Scale(metres, 4)
        armature.show_in_front = True
        write_reliability(armature, *source, frames, result.confidence)
        write_residual(armature, source, frames, result.residual)
        kept = TrackedBody(result.body, shown, result.floor, settings.actor)
        kept.write(armature, dict(zip(result.motion.skeleton.names, bones, strict=True)))
    action = source[0]
    store_json(action, CAPTURED, _entry(settings, result, shown))
    list_doubts(scene, action, frames, result.doubts, _said(result))
    return f"{armature.name}: {_said(result)}"


def _place(preview: bpy.types.Object, floor: Floor | None) -> Matrix:
    """Return where the world of the motion is in the scene: as the points were put there."""
    motion_from_camera = scene_from_camera(floor)
    return preview.matrix_world @ Matrix(np.linalg.inv(motion_from_camera).tolist())


def _said(result: Tracked) -> str:
    off = mean_cm(result.residual)
    beside = "" if off is None else f"; mean distance from the points {off:.1f} cm"
    n_restarts, n_doubts = len(result.restarts), len(result.doubts)
    helped = f" Redetected {n_restarts} times." if n_restarts else ""
    doubtful = {0: "No low-confidence ranges.", 1: "1 low-confidence range."}.get(
        n_doubts, f"{n_doubts} low-confidence ranges."
    )
    said = f"{result.motion.n_frames} frames{beside}.{helped} {doubtful}"
    return " ".join([said, *result.remarks])


def _entry(settings: TrackBundle, result: Tracked, shown: Shown) -> dict[str, object]:
    return {
        "version": version(),
        "operation": "track_depth",
        "settings": history.plain(
            settings.choices, settings.tracking, settings.actor, settings.planting
        ),
        "recording": shown.path,
        "mean_residual_cm": mean_cm(result.residual),
        "coverage": result.coverage,
        "restarts": list(result.restarts),
        "doubtful_ranges": len(result.doubts),
    }
