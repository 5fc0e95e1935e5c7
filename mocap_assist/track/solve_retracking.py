"""Solve of the button Track from Here: follow the images from a corrected frame."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...solvers.depth_scene import (
    DepthRecording,
    FloorPlane,
    ForegroundSettings,
    find_actor,
    find_people,
)
from ...solvers.depth_tracking import BodyModel, Retracked, RetrackSettings, retrack
from ...solvers.depth_tracking.tracking import offset_frames
from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched, within
from .pose_previews import FloorPreview, PosePreviewSender, Show, no_preview

ACTOR_FRACTION = 0.3
"""Fraction of the progress for the separation of the actor from the room."""


class TrackedActor(NamedTuple):
    """Motion of an armature, with the recording and body of its actor."""

    recording: DepthRecording
    actor: ForegroundSettings
    body: BodyModel
    floor: FloorPlane | None
    first: int
    """Index of the depth image at the start of the motion."""
    motion: Motion
    person: int | None = None
    """Index of the actor among all people; None if only one was tracked."""


class Correction(NamedTuple):
    """An animator's pose at one frame."""

    frame: int
    """Frame of the motion."""
    pose: Motion
    """One frame."""
    fixed: tuple[int, ...]
    """Other corrected frames of the motion."""


def retrack_recording(
    played: TrackedActor,
    correction: Correction,
    settings: RetrackSettings,
    *,
    show: Show = no_preview,
    progress: Progress = unwatched,
) -> Retracked:
    """Track again from a corrected frame; show each pose as it is found."""
    actor_only = _actor_only(played, within(progress, 0.0, ACTOR_FRACTION))
    n_frames, first = played.motion.n_frames, played.first
    segment = DepthRecording(
        actor_only.camera,
        n_frames,
        actor_only.frame_rate,
        lambda frame: actor_only.frame(first + frame),
        read_occluders=lambda frame: actor_only.occluders(first + frame),
    )
    show(FloorPreview(played.floor))
    return retrack(
        segment,
        played.body,
        corrected(played.motion, correction),
        correction.frame,
        floor=played.floor,
        fixed=correction.fixed,
        settings=settings,
        on_pose=offset_frames(PosePreviewSender(show), first),
        progress=within(progress, ACTOR_FRACTION, 1.0),
    )


def _actor_only(played: TrackedActor, progress: Progress) -> DepthRecording:
    """Return the recording of the actor alone.

    Raises InvalidMotionError if the person is not found again.
    """
    if played.person is None:
        return find_actor(played.recording, played.actor, progress=progress).recording
    actors = find_people(played.recording, played.actor, progress=progress).actors
    if not 0 <= played.person < len(actors):
        raise InvalidMotionError(
            f"Only {len(actors)} people are found in the recording now. Track it again."
        )
    return actors[played.person].recording


def corrected(motion: Motion, correction: Correction) -> Motion:
    """Return a motion with the animator's pose in it."""
    rotations, root_positions = np.array(motion.rotations), np.array(motion.root_positions)
    rotations[correction.frame] = correction.pose.rotations[0]
    root_positions[correction.frame] = correction.pose.root_positions[0]
    return replace(motion, rotations=rotations, root_positions=root_positions)
