"""A depth recording as an object of the scene."""

from pathlib import Path

import bpy

from ...solvers.depth_scene import LEVEL, DepthRecording, check_intrinsics, find_floor
from ...solvers.progress import Progress, unwatched
from ..blender.permissions import allow_recording
from ..depth.depth_preview import Shown, build_preview, cheap_step
from ..scene.scene_rate import timing
from ..scene.units import unit_of
from .button_settings import ImportChoices
from .recording_objects import CreatedObjects


def make_preview(
    context: bpy.types.Context,
    path: Path,
    recording: DepthRecording,
    choices: ImportChoices,
    *,
    progress: Progress = unwatched,
) -> CreatedObjects:
    """Add the animated point cloud of a recording, on the floor if one is detected."""
    samples = timing(
        context.scene, choices.frame_rate, recording.frame_rate, choices.frame_start
    )
    floor = find_floor(recording, progress=progress)
    every = cheap_step(recording)
    shown = Shown(str(path), choices.depth, samples.start, samples.step, every)
    allow_recording(shown.path)
    scale = choices.global_scale / unit_of(context.scene)
    made = build_preview(context, path.stem, recording, shown, floor or LEVEL, scale)
    camera = recording.camera
    what = (
        f"depth of {camera.width} x {camera.height} pixels",
        "on the floor" if floor else "without a floor",
    )
    last_frame = float(samples.frames(recording.n_frames)[-1])
    return CreatedObjects(made, None, last_frame, what, notes=tuple(check_intrinsics(camera)))
