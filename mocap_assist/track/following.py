"""Track Live: follow a recording that is being written, and add the tracked armature."""

from dataclasses import dataclass, replace
from functools import partial
from math import ceil, floor, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import bpy
import numpy as np

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import LEVEL, Camera, DepthRecording, ForegroundSettings
from ...solvers.depth_tracking.capturing import CaptureSettings
from ...solvers.errors import InvalidFileError, InvalidSettingError
from ...solvers.faults import Failure, attempt
from ...solvers.recordings import DepthSettings, Unit
from ...solvers.settings import setting
from ...solvers.workflows.following import FollowSettings
from ..blender.block_references import BlockReference
from ..blender.path_properties import absolute
from ..blender.permissions import allow_recording
from ..blender.time_slices import Sliced, Steps, in_thread
from ..depth.camera_choices import DepthCameraChoices
from ..depth.depth_preview import (
    MAX_POINTS,
    Shown,
    build_preview,
    cheap_step,
    close_recordings,
    open_recording,
)
from ..jobs.protocol import EndableSolve
from ..scene import history
from ..scene.origin import note_origin, origin_of_file
from ..scene.other_animation import is_animated
from ..scene.scene_objects import undo_on_error
from ..scene.scene_rate import scene_rate, set_duration, set_scene_rate
from ..scene.units import unit_of
from .following_view import FollowingView
from .solve_following import Followed, FollowProblem, follow_recording
from .solve_tracking import Tracked
from .tracking import FeetChoices, TrackBundle, TrackChoices, add_armature

OPERATION = "track_live"
NO_FOLDER = "Choose the folder that the recorder writes to, or its .mkv file."
IMAGES = (".png",)
WITHIN = ("depth",)
"""Folders of images within a recording."""


@dataclass(frozen=True, kw_only=True)
class FollowChoices(DepthCameraChoices):
    """The recording that Track Live follows, and what its files may not state."""

    recording_file: str = setting(
        "", "Folder of depth images that a recorder writes to, or its .mkv file",
        label="Folder",
    )  # fmt: skip
    unit: Unit = setting(Unit.GUESS, "Unit of the depth values; Auto reads it from the files")
    frame_rate: float = setting(
        0.0, "Images per second; 0 reads the file or uses 30", unit="Hz",
        minimum=0.0, maximum=10_000.0,
    )  # fmt: skip


class FollowPanelBundle(NamedTuple):
    """Settings of the panel; the others are those of Track."""

    recording: FollowChoices
    following: FollowSettings


class FollowBundle(NamedTuple):
    """Settings of the button."""

    recording: FollowChoices
    following: FollowSettings
    choices: FeetChoices
    tracking: CaptureSettings
    actor: ForegroundSettings
    planting: PlantSettings


def read_following(
    scene: bpy.types.Scene, same: bpy.types.Scene, settings: FollowBundle
) -> EndableSolve[Followed]:
    """Return the solve, which follows the recording.

    Raises InvalidSettingError if none is chosen.
    """
    if not settings.recording.recording_file.strip():
        raise InvalidSettingError(NO_FOLDER)
    problem = FollowProblem(
        recording_of(absolute(settings.recording.recording_file)),
        depth_settings(settings),
        settings.following,
        settings.tracking,
        settings.actor,
        settings.planting if settings.choices.plant_feet else None,
        scene.frame_current_final,
    )
    return EndableSolve(follow_recording, problem)


def depth_settings(settings: FollowBundle) -> DepthSettings:
    """Return the settings of the depth images."""
    given = settings.recording
    return given.depth_settings(given.unit, given.frame_rate)


def recording_of(path: Path) -> Path:
    """Return the recording of a chosen file: for an image, its folder."""
    if path.suffix.lower() not in IMAGES:
        return path
    folder = path.parent
    return folder.parent if folder.name.lower() in WITHIN else folder


def watch_following(
    scene: bpy.types.Scene, same: bpy.types.Scene, settings: FollowBundle
) -> FollowingView:
    """Return the view of the actor and the body while they are tracked."""
    return FollowingView(scene)


@Sliced
def write_followed(
    scene: bpy.types.Scene,
    same: bpy.types.Scene,
    settings: FollowBundle,
    result: Followed,
    solved_digest: str | None = None,
) -> Steps[str]:
    """Add the points of the recording, and the armature over them; return a message.

    If nothing else is animated, the scene plays the motion at its rate. Points of a recording
    that cannot be read are hidden.
    """
    reference = BlockReference.of(scene)
    shown = Shown(str(result.path), depth_settings(settings), 0.0, 1.0, 1)
    close_recordings()
    opened = yield from in_thread.steps(partial(attempt, result.path, _open, shown))
    scene = reference.find()
    with undo_on_error(bpy.context):
        fits_scene = not is_animated(scene)
        if fits_scene:
            set_scene_rate(scene, result.tracked.motion.frame_rate)
        points, tracked = _add_points(scene, result, shown, opened)
        message = add_armature(
            scene, points, _track_bundle(settings), tracked, origin=_origin(settings)
        )
        if fits_scene:
            n_frames = tracked.motion.n_frames
            first = floor(result.first_frame)
            set_duration(scene, first, first + n_frames - 1)
    return f"{message} {opened.sentence}" if isinstance(opened, Failure) else message


def _open(shown: Shown) -> tuple[DepthRecording, int]:
    """Return the recording, and the step between its columns and rows that become points.

    Damaged images, of which the step could not be found, have no points; the others have.
    """
    recording = open_recording(shown)
    try:
        return recording, cheap_step(recording)
    except InvalidFileError:
        return recording, _safe_step(recording.camera)


def _safe_step(camera: Camera) -> int:
    """Return a step that suits any image."""
    return ceil(sqrt(camera.width * camera.height / MAX_POINTS))


def _track_bundle(settings: FollowBundle) -> TrackBundle:
    choices = TrackChoices(plant_feet=settings.choices.plant_feet)
    return TrackBundle(choices, settings.tracking, settings.actor, settings.planting)


def _origin(settings: FollowBundle) -> dict[str, Any]:
    return {"operation": OPERATION, "following": history.json_ready(settings.following)}


def _add_points(
    scene: bpy.types.Scene,
    result: Followed,
    shown: Shown,
    opened: tuple[DepthRecording, int] | Failure,
) -> tuple[bpy.types.Object, Tracked]:
    """Return new points so that the motion begins at its frame, and the motion in their time.

    Points of a recording that cannot be opened say why they are hidden.
    """
    tracked = result.tracked
    if isinstance(opened, Failure):
        rate = tracked.motion.frame_rate
        recording = DepthRecording(result.camera, 1, rate, lambda _: np.zeros((0, 0), "f4"))
        every = _safe_step(result.camera)
    else:
        recording, every = opened
        rate = recording.frame_rate
        tracked = tracked._replace(images_per_frame=rate / tracked.motion.frame_rate)
    step = scene_rate(scene) / rate
    start = result.first_frame - step * tracked.images_per_frame * tracked.first
    shown = replace(shown, start=start, step=step, every=every)
    allow_recording(shown.path)
    path, plane, scale = result.path, tracked.floor or LEVEL, 1.0 / unit_of(scene)
    points = build_preview(bpy.context, path.stem, recording, shown, plane, scale)
    note_origin(points, origin_of_file(path, recording))
    return points, tracked
