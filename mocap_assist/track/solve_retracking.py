"""What the button Track from Here has solved for it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...solvers.depth_scene import DepthRecording, Floor, ForegroundSettings, find_actor
from ...solvers.depth_tracking import BodyModel, Retracked, RetrackSettings, retrack
from ...solvers.depth_tracking.tracking import offset_frames
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched, within
from .pose_previews import Glimpses, Place, Show, unseen

FOUND = 0.3
"""Share of the work after which the actor is told from the room."""


class Played(NamedTuple):
    """What an armature plays of a recording, and whom that shows."""

    recording: DepthRecording
    actor: ForegroundSettings
    body: BodyModel
    floor: Floor | None
    first: int
    """Picture of the recording with which the motion begins."""
    motion: Motion


class Correction(NamedTuple):
    """The pose that an animator has given to a frame."""

    frame: int
    """Of the motion."""
    pose: Motion
    """One frame."""
    fixed: tuple[int, ...]
    """Other frames of the motion that are right."""


def retrack_recording(
    played: Played,
    correction: Correction,
    settings: RetrackSettings,
    *,
    show: Show = unseen,
    progress: Progress = unwatched,
) -> Retracked:
    """Track again from a corrected frame; show each pose, as `Onlooker` understands it."""
    alone = find_actor(
        played.recording, played.actor, progress=within(progress, 0.0, FOUND)
    ).recording
    n_frames, first = played.motion.n_frames, played.first
    part = DepthRecording(
        alone.camera, n_frames, alone.frame_rate, lambda frame: alone.frame(first + frame)
    )
    show(Place(played.floor))
    return retrack(
        part,
        played.body,
        corrected(played.motion, correction),
        correction.frame,
        floor=played.floor,
        fixed=correction.fixed,
        settings=settings,
        on_pose=offset_frames(Glimpses(show), first),
        progress=within(progress, FOUND, 1.0),
    )


def corrected(motion: Motion, correction: Correction) -> Motion:
    """Return a motion with the animator's pose in it."""
    rotations, places = np.array(motion.rotations), np.array(motion.root_positions)
    rotations[correction.frame] = correction.pose.rotations[0]
    places[correction.frame] = correction.pose.root_positions[0]
    return replace(motion, rotations=rotations, root_positions=places)
