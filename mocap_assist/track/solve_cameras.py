"""Solve of the button Track for the recordings of several cameras."""

from typing import NamedTuple

import numpy as np

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import DepthRecording, ForegroundSettings
from ...solvers.depth_tracking.capturing import CaptureSettings
from ...solvers.depth_tracking.several_cameras import AlignmentSettings
from ...solvers.progress import Progress, unwatched, within
from ...solvers.workflows import capture_seen_actor, find_actor_of_cameras
from .pose_previews import FloorPreview, ObjectNumber, PosePreviewSender, Show, no_preview
from .solve_tracking import ACTOR_FRACTION, FoundCamera, Tracked, build_tracked


class OtherCamera(NamedTuple):
    """A recording of the same take, and its object."""

    recording: DepthRecording
    object_number: ObjectNumber


class SeveralCameras(NamedTuple):
    """Recordings of one take; the first one defines times and frame rate."""

    first: DepthRecording
    others: tuple[OtherCamera, ...]


def track_cameras(
    cameras: SeveralCameras,
    tracking: CaptureSettings,
    actor: ForegroundSettings,
    planting: PlantSettings | None,
    alignment: AlignmentSettings,
    *,
    show: Show = no_preview,
    progress: Progress = unwatched,
) -> Tracked:
    """Capture the actor whom several cameras show; send previews as `track_recording` does."""
    recordings = [cameras.first, *(other.recording for other in cameras.others)]
    actors = find_actor_of_cameras(
        recordings, actor, progress=within(progress, 0.0, ACTOR_FRACTION)
    )
    numbers = tuple(other.object_number for other in cameras.others)
    show(FloorPreview(actors[0].floor, numbers))
    done = capture_seen_actor(
        actors,
        settings=tracking,
        alignment=alignment,
        planting=planting,
        on_pose=PosePreviewSender(show),
        progress=within(progress, ACTOR_FRACTION, 1.0),
    )
    tracked = build_tracked(0, done.motion, done.captured, done.actor.floor, done.remarks)
    found = tuple(
        FoundCamera(
            other.object_number,
            np.linalg.inv(alignment.camera_from_first),
            alignment.offset,
            alignment.mismatch,
            shows_floor=seen.floor is not None,
        )
        for other, alignment, seen in zip(
            cameras.others, done.alignments[1:], actors[1:], strict=True
        )
    )
    return tracked._replace(
        other_numbers=numbers, cameras=found, first_shows_floor=actors[0].floor is not None
    )
