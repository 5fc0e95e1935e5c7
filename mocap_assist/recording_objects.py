"""Recordings as objects of the scene: armatures for joints, empties for markers."""

from dataclasses import replace
from typing import NamedTuple

import bpy

from ..solvers.motion import (
    JointRecording,
    Motion,
    Skeleton,
    Tracks,
    motion_from_points,
    resample,
)
from ..solvers.progress import Progress, unwatched
from .import_choices import ImportChoices, Target
from .scene.armature_build import build_armature
from .scene.empties_build import build_empties, write_tracks
from .scene.new_action import write_motion
from .scene.scene_rate import FrameRate, Timing, scene_rate, timing
from .scene.units import unit_of


class Made(NamedTuple):
    """What a recording became."""

    top: bpy.types.Object
    """The armature, or the empty that holds the markers."""
    actions: tuple[bpy.types.Action, ...]
    last_frame: float
    what: str
    """In words."""


def make_objects(
    context: bpy.types.Context,
    name: str,
    recording: Motion | Tracks | JointRecording,
    choices: ImportChoices,
    *,
    progress: Progress = unwatched,
) -> Made:
    """Add what moves as the recording does; only `Update Scene FPS` is left to the caller."""
    scene = context.scene
    when = timing(scene, choices.frame_rate, recording.frame_rate, choices.frame_start)
    moving = scaled(_as_target(recording, choices.target), choices.global_scale)
    if choices.frame_rate is FrameRate.RESAMPLE:
        moving = resample(moving, scene_rate(scene))
        when = when._replace(step=1.0)
    if isinstance(moving, Motion):
        return _make_armature(context, name, moving, when, choices, progress)
    return _make_empties(context, name, moving, when, progress)


def _as_target(recording: Motion | Tracks | JointRecording, target: Target) -> Motion | Tracks:
    """Turn the joints of a camera into a motion, where an armature is wanted and they hang
    together; into points otherwise.
    """
    if not isinstance(recording, JointRecording):
        return recording
    if target is Target.ARMATURE and recording.parents.count(-1) == 1 < recording.n_joints:
        return motion_from_points(recording.tracks, recording.parents)
    return recording.tracks


def scaled(recording: Motion | Tracks, factor: float) -> Motion | Tracks:
    """Return the recording with all lengths so many times as long."""
    if factor == 1.0:
        return recording
    if isinstance(recording, Tracks):
        return recording.with_positions(factor * recording.positions)
    skeleton = recording.skeleton
    larger = Skeleton(skeleton.names, skeleton.parents, factor * skeleton.offsets)
    return replace(recording, skeleton=larger, root_positions=factor * recording.root_positions)


def _make_armature(
    context: bpy.types.Context,
    name: str,
    motion: Motion,
    when: Timing,
    choices: ImportChoices,
    progress: Progress,
) -> Made:
    metres, mode = unit_of(context.scene), choices.rotate_mode.name
    armature, bones = build_armature(context, name, motion.skeleton, metres, mode)
    frames = when.frames(motion.n_frames)
    action, _ = write_motion(armature, bones, motion, frames, metres, progress=progress)
    what = f"an armature of {len(armature.data.bones)} bones"
    return Made(armature, (action,), float(frames[-1]), what)


def _make_empties(
    context: bpy.types.Context, name: str, tracks: Tracks, when: Timing, progress: Progress
) -> Made:
    metres = unit_of(context.scene)
    holder, empties = build_empties(context, name, tracks.names, metres)
    frames = when.frames(tracks.n_frames)
    action = write_tracks(name, empties, tracks, frames, metres, progress=progress)
    return Made(holder, (action,), float(frames[-1]), f"{tracks.n_points} empties")
