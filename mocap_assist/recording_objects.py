"""Recordings as objects of the scene: armatures for joints, empties for markers."""

from dataclasses import replace
from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..solvers.errors import InvalidMotionError
from ..solvers.motion import (
    JointRecording,
    Motion,
    Skeleton,
    Tracks,
    joint_parents,
    motion_from_points,
    resample,
)
from ..solvers.progress import Progress, unwatched
from .import_choices import ImportChoices, Target
from .scene import compat
from .scene.armature_build import build_armature
from .scene.empties_build import build_empties, write_tracks
from .scene.new_action import write_motion
from .scene.scene_rate import FrameRate, scene_rate, timing
from .scene.sensor_words import words_of, write_words
from .scene.units import unit_of

Array = NDArray[np.float64]
NAMED = 3  # joints that a sentence lists


class Words(NamedTuple):
    """What the sensor said, at its own samples even where the motion is resampled."""

    frames: Array
    """Scene frames, shape (n_samples,)."""
    said: dict[str, dict[str, Array]]
    """By joint or marker."""

    def of(self, name: str) -> tuple[Array, dict[str, Array]]:
        """Return the frames and what was said of one joint or marker."""
        return self.frames, self.said.get(name, {})


class Made(NamedTuple):
    """What a recording became."""

    top: bpy.types.Object
    """The armature, or the empty that holds the markers."""
    action: bpy.types.Action
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
    """Add what moves as the recording does; the scene's settings stay as they are."""
    scene = context.scene
    samples = timing(scene, choices.frame_rate, recording.frame_rate, choices.frame_start)
    moving = scaled(_as_target(recording, choices.target), choices.global_scale)
    when = samples
    if choices.frame_rate is FrameRate.RESAMPLE:
        moving = resample(moving, scene_rate(scene))
        when = samples._replace(step=1.0)
    frames = when.frames(moving.n_frames)
    words = Words(samples.frames(recording.n_frames), words_of(recording))
    if isinstance(moving, Motion):
        mode = choices.rotate_mode.name
        made = _make_armature(context, name, moving, mode, frames, words, progress)
    else:
        made = _make_empties(context, name, moving, frames, words, progress)
    what = made.what
    wanted = choices.target is Target.ARMATURE and isinstance(recording, JointRecording)
    if wanted and not isinstance(moving, Motion):
        what += ", since nothing tells which joint hangs on which"
    elif wanted and (n_loose := recording.n_joints - len(_hanging(recording))):
        what += f", without {n_loose} points that hang on no joint"
    return made._replace(what=what + _never_seen(recording))


def _never_seen(recording: Motion | Tracks | JointRecording) -> str:
    """Name the joints or markers that were left out."""
    if isinstance(recording, Motion):
        return ""
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    lost = [tracks.names[point] for point in np.flatnonzero(~tracks.visible.any(axis=0))]
    if not lost:
        return ""
    more = f" and {len(lost) - NAMED} more" * (len(lost) > NAMED)
    return f", without {', '.join(lost[:NAMED])}{more}, never seen"


def in_one_tree(recording: JointRecording) -> bool:
    """Whether it is known which joint hangs on which, so that they can become an armature."""
    parents = recording.parents
    return sum(parents[joint] < 0 for joint in _hanging(recording)) == 1


def _hanging(recording: JointRecording) -> list[int]:
    """Return the joints that hang on another, or that others hang on."""
    parents = recording.parents
    return [joint for joint, parent in enumerate(parents) if parent >= 0 or joint in parents]


def _as_target(recording: Motion | Tracks | JointRecording, target: Target) -> Motion | Tracks:
    """Turn the joints of a camera into a motion, where an armature is wanted and they hang
    together; into points otherwise.
    """
    if not isinstance(recording, JointRecording):
        return recording
    if target is Target.ARMATURE and in_one_tree(recording):
        kept, tracks = _hanging(recording), recording.tracks
        names = tuple(tracks.names[joint] for joint in kept)
        body = Tracks(names, tracks.positions[:, kept], tracks.frame_rate)
        return motion_from_points(body, joint_parents(names))
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


def _seen(tracks: Tracks) -> Tracks:
    """Leave out points that were never seen: they would stand at the origin, seen for sure."""
    seen = np.flatnonzero(tracks.visible.any(axis=0))
    if not len(seen):
        raise InvalidMotionError("No point is ever seen.")
    confidence = None if tracks.confidence is None else tracks.confidence[:, seen]
    names = tuple(tracks.names[point] for point in seen)
    return Tracks(names, tracks.positions[:, seen], tracks.frame_rate, confidence)


def _make_armature(
    context: bpy.types.Context,
    name: str,
    motion: Motion,
    mode: str,
    frames: Array,
    words: Words,
    progress: Progress,
) -> Made:
    metres = unit_of(context.scene)
    armature, bones = build_armature(context, name, motion.skeleton, metres, mode)
    action, slot = write_motion(armature, bones, motion, frames, metres, progress=progress)
    bag = compat.channelbag(action, slot)
    for joint, bone in zip(motion.skeleton.names, bones, strict=True):
        if bone:
            write_words(bag, armature.pose.bones[bone], *words.of(joint))
    what = f"an armature of {len(armature.data.bones)} bones"
    return Made(armature, action, float(frames[-1]), what)


def _make_empties(
    context: bpy.types.Context,
    name: str,
    tracks: Tracks,
    frames: Array,
    words: Words,
    progress: Progress,
) -> Made:
    metres = unit_of(context.scene)
    tracks = _seen(tracks)
    holder, empties = build_empties(context, name, tracks.names, metres)
    action = write_tracks(name, empties, tracks, frames, metres, progress=progress)
    for point, empty in zip(tracks.names, empties, strict=True):
        write_words(
            compat.channelbag(action, empty.animation_data.action_slot), empty, *words.of(point)
        )
    return Made(holder, action, float(frames[-1]), f"{tracks.n_points} empties")
