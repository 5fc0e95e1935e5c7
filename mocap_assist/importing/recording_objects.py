"""Recordings as objects of the scene: armatures for joints, empties for markers."""

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.motion.humanoid import fill_missing_hips
from ...solvers.progress import Progress, unwatched
from ..actions.armature_build import build_armature
from ..actions.empties_build import build_empties, write_tracks
from ..actions.new_action import write_motion
from ..actions.sensor_notes import words_of, write_words
from ..blender import compat
from ..scene.scene_rate import FrameRate, scene_rate, timing
from ..scene.units import unit_of
from .choices import ImportChoices, Target
from .solve_reading import Pointwise, Wanted, hanging, moved

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
    """The armature, the empty that holds the markers, or the points of depth."""
    action: bpy.types.Action | None
    """None for depth, which is read from its files."""
    last_frame: float
    what: str
    """In words."""


def wanted_of(context: bpy.types.Context, choices: ImportChoices) -> Wanted:
    """Return what choices mean for recordings before they come into the scene."""
    resampled = choices.frame_rate is FrameRate.RESAMPLE
    return Wanted(
        choices.target is Target.ARMATURE,
        choices.global_scale,
        scene_rate(context.scene) if resampled else None,
        choices.unit.metres,
        choices.depth,
    )


def make_objects(
    context: bpy.types.Context,
    name: str,
    recording: Pointwise,
    choices: ImportChoices,
    *,
    moving: Motion | Tracks | None = None,
    progress: Progress = unwatched,
) -> Made:
    """Add what moves as the recording does; the scene's settings stay as they are.

    `moving` is what the recording becomes (`moved`), if that is known already.
    """
    scene = context.scene
    samples = timing(scene, choices.frame_rate, recording.frame_rate, choices.frame_start)
    if moving is None:
        moving = moved(recording, wanted_of(context, choices))
    resampled = choices.frame_rate is FrameRate.RESAMPLE
    frames = (samples._replace(step=1.0) if resampled else samples).frames(moving.n_frames)
    words = Words(samples.frames(recording.n_frames), words_of(recording))
    if isinstance(moving, Motion):
        mode = choices.rotate_mode.name
        made = _make_armature(context, name, moving, mode, frames, words, progress)
    else:
        made = _make_empties(context, name, moving, frames, words, progress)
    what = made.what
    if choices.target is not Target.ARMATURE or not isinstance(recording, JointRecording):
        pass
    elif not isinstance(moving, Motion):
        what += ", since the parents of the joints are unknown"
    elif n_loose := recording.n_joints - len(hanging(recording)):
        what += f", without {n_loose} points that have no joint"
    return made._replace(what=what + _never_seen(recording, made.top.type == "ARMATURE"))


def _never_seen(recording: Pointwise, in_armature: bool) -> str:
    """Name the joints or markers that were left out, or put where they must have been."""
    if isinstance(recording, Motion):
        return ""
    if in_armature and isinstance(recording, JointRecording):
        whole = fill_missing_hips(recording)
        if whole is not recording:
            return f", with hips added between the legs{_never_seen(whole, True)}"
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    lost = [tracks.names[point] for point in np.flatnonzero(~tracks.visible.any(axis=0))]
    if not lost:
        return ""
    more = f" and {len(lost) - NAMED} more" * (len(lost) > NAMED)
    return f", without {', '.join(lost[:NAMED])}{more} (never observed)"


def _seen(tracks: Tracks) -> Tracks:
    """Leave out points that were never seen: they would stand at the origin, seen for sure."""
    seen = np.flatnonzero(tracks.visible.any(axis=0))
    if not len(seen):
        raise InvalidMotionError("The recording has no observed points.")
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
