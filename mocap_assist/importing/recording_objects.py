"""Recordings as objects of the scene: armatures for joints, empties for markers."""

from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.motion.humanoid import fill_missing_hips
from ...solvers.progress import Progress, unwatched
from ..actions.armature_build import build_armature
from ..actions.bone_lengths import key_lengths
from ..actions.new_action import write_motion
from ..actions.sensor_notes import sensor_values, write_sensor_values
from ..blender import compat
from ..blender.data_names import fitting_name
from ..jobs.in_blender import BackgroundBlender
from ..scene.origin import note_origin, origin_of_file
from ..scene.scene_rate import FrameRate, scene_rate, timing
from ..scene.units import unit_of
from .button_settings import ImportChoices, ImportTarget
from .marker_objects import Timed, make_markers, observed_points
from .sensor_samples import SensorSamples
from .solve_reading import (
    Conversion,
    ReadRecording,
    TrackedRecording,
    at_rate,
    connected_joints,
    convert_takes,
    convert_tracked,
)

MAX_NAMED = 3  # joints that a sentence lists


class CreatedObjects(NamedTuple):
    """Objects of a recording."""

    top: bpy.types.Object
    """The armature, the parent of the markers, or the animated point cloud."""
    action: bpy.types.Action | None
    """None for depth, which is read from its files."""
    last_frame: float
    what: tuple[str, ...]
    """Clauses of the report."""
    bones: tuple[str, ...] = ()
    """Of an armature, the bone of each joint, or nothing."""
    notes: tuple[str, ...] = ()
    """Further sentences of the report."""


def conversion_from_choices(context: bpy.types.Context, choices: ImportChoices) -> Conversion:
    """Return the conversion that the choices define."""
    resampled = choices.frame_rate is FrameRate.RESAMPLE
    return Conversion(
        choices.target is ImportTarget.ARMATURE,
        choices.global_scale,
        scene_rate(context.scene) if resampled else None,
        choices.reading,
        choices.depth,
        choices.place_on_floor,
        choices.keep_meshes,
        choices.body,
        BackgroundBlender(str(bpy.app.binary_path)),
    )


def make_objects(
    context: bpy.types.Context,
    name: str,
    recording: TrackedRecording,
    choices: ImportChoices,
    *,
    moving: Motion | Tracks | None = None,
    progress: Progress = unwatched,
) -> CreatedObjects:
    """Add the animated objects of a recording; the scene's settings are not changed.

    `moving` is the result of `convert_tracked`, if it exists already.
    """
    scene = context.scene
    samples = timing(scene, choices.frame_rate, recording.frame_rate, choices.frame_start)
    if moving is None:
        moving = convert_tracked(recording, conversion_from_choices(context, choices))
    sensor_samples = SensorSamples(samples.frames(recording.n_frames), sensor_values(recording))
    if choices.frame_rate is FrameRate.RESAMPLE:
        moving, samples = at_rate(moving, scene_rate(scene)), samples._replace(step=1.0)
        sensor_samples = sensor_samples.on_frames(samples.frames(moving.n_frames))
    frames = samples.frames(moving.n_frames)
    if isinstance(moving, Motion):
        mode = choices.rotate_mode.name
        is_tracked = isinstance(recording, JointRecording)
        made = _make_armature(
            context, name, moving, mode, frames, sensor_samples, is_tracked, progress
        )
    else:
        timed = Timed(moving, frames, sensor_samples)
        made = _make_empties(context, name, recording, timed, progress)
    what = made.what
    if choices.target is not ImportTarget.ARMATURE or not isinstance(recording, JointRecording):
        pass
    elif not isinstance(moving, Motion):
        what = (*what, "since the parents of the joints are unknown")
    elif n_loose := recording.n_joints - len(connected_joints(recording)):
        what = (*what, f"without {n_loose} points that have no joint")
    left_out, notes = _never_observed(recording, isinstance(moving, Motion))
    return made._replace(what=what + left_out, notes=made.notes + notes)


def _never_observed(
    recording: TrackedRecording, in_armature: bool
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return clauses and sentences about joints or markers that were left out or added."""
    if isinstance(recording, Motion):
        return (), ()
    if in_armature and isinstance(recording, JointRecording):
        completed = fill_missing_hips(recording)
        if completed is not recording:
            clauses, notes = _never_observed(completed, True)
            return ("with hips added between the legs", *clauses), notes
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    never_observed = [
        tracks.names[point] for point in np.flatnonzero(~tracks.visible.any(axis=0))
    ]
    if not never_observed:
        return (), ()
    listed = ", ".join(never_observed[:MAX_NAMED])
    if more := never_observed[MAX_NAMED:]:
        return (), (f"Left out, since never observed: {listed} and {len(more)} more.",)
    return (), (f"Left out, since never observed: {listed}.",)


def _make_armature(
    context: bpy.types.Context,
    name: str,
    motion: Motion,
    mode: str,
    frames: Array,
    sensor_samples: SensorSamples,
    is_tracked: bool,
    progress: Progress,
) -> CreatedObjects:
    """Add an armature; Reconstruct can change the lengths of bones that a camera tracked."""
    meters = unit_of(context.scene)
    armature, bones = build_armature(
        context, name, motion.skeleton, meters, mode, connected=not is_tracked
    )
    action, slot = write_motion(armature, bones, motion, frames, meters, progress=progress)
    bag = compat.channelbag(action, slot)
    if is_tracked:
        key_lengths(action, slot, {bone: np.zeros(3) for bone in bones[1:] if bone}, frames[0])
    for joint, bone in zip(motion.skeleton.names, bones, strict=True):
        if bone:
            write_sensor_values(bag, armature.pose.bones[bone], *sensor_samples.of(joint))
    what = (f"an armature of {len(armature.data.bones)} bones",)
    return CreatedObjects(armature, action, float(frames[-1]), what, bones)


def add_takes(
    context: bpy.types.Context,
    made: CreatedObjects,
    path: Path,
    content: ReadRecording,
    choices: ImportChoices,
) -> CreatedObjects:
    """Add an action for each further take of an armature; the first one stays assigned.

    Actions are called like their takes.
    """
    assert made.action is not None
    scene, meters = context.scene, unit_of(context.scene)
    made.action.name = fitting_name(content.take)
    slot, last, names = made.top.animation_data.action_slot, made.last_frame, [content.take]
    conversion = conversion_from_choices(context, choices)
    if choices.frame_rate is FrameRate.UPDATE:  # the scene gets the rate of the first take
        conversion = conversion._replace(frame_rate=content.recording.frame_rate)
    for take in convert_takes(content.others, conversion):
        rate = take.motion.frame_rate
        samples = timing(scene, choices.frame_rate, rate, choices.frame_start)
        frames = samples.frames(take.motion.n_frames)
        action, _ = write_motion(
            made.top, made.bones, take.motion, frames, meters, name=fitting_name(take.name)
        )
        scale, body = choices.global_scale, content.body
        note_origin(action, origin_of_file(path, take.motion, scale, body))
        names.append(take.name)
        last = max(last, float(frames[-1]))
    compat.assign(made.top, made.action, slot)
    listed, more = ", ".join(names[:MAX_NAMED]), names[MAX_NAMED:]
    note = f"Takes: {listed} and {len(more)} more." if more else f"Takes: {listed}."
    what = (*made.what, f"{len(names)} takes as actions")
    return made._replace(last_frame=last, what=what, notes=(*made.notes, note))


def _make_empties(
    context: bpy.types.Context,
    name: str,
    recording: TrackedRecording,
    timed: Timed,
    progress: Progress,
) -> CreatedObjects:
    observed = observed_points(timed.tracks)
    if not observed:
        raise InvalidMotionError("The recording has no observed points.")
    parents = None
    if isinstance(recording, JointRecording):
        row_of = {joint: row for row, joint in enumerate(observed)}
        parents = [row_of.get(recording.parents[joint], -1) for joint in observed]
    holder, action, what = make_markers(context, name, timed.of(observed), parents, progress)
    return CreatedObjects(holder, action, float(timed.frames[-1]), what)
