"""Capture the motion of an actor from the raw recordings of several depth cameras."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...denoising import PlantSettings
from ...depth_scene import Actor, DepthRecording, ForegroundSettings, find_actor
from ...depth_tracking.body import BodyModel, MotionPrior
from ...depth_tracking.capturing import CaptureSettings
from ...depth_tracking.several_cameras import (
    AlignmentSettings,
    CapturedByCameras,
    about_camera,
    camera_named,
    capture_cameras,
    check_different,
)
from ...depth_tracking.tracking import PoseCallback, ignore_pose
from ...progress import Progress, unwatched, within
from .capture_recording import (
    CAPTURE_SETTINGS,
    FOREGROUND_FRACTION,
    FOREGROUND_SETTINGS,
    PLANT_SETTINGS,
    CapturedMotion,
    finish_capture,
)

ALIGNMENT_SETTINGS = AlignmentSettings()
MAX_MISMATCH_M = 0.05
"""Mean distance of the skeletons of two cameras, meters, above which one of them is likely to
be wrong. Measured: made sequences have 1 to 4 cm, and a wrong frame rate 10."""


def capture_from_cameras(
    recordings: Sequence[DepthRecording],
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    empty: Sequence[int] = (),
    settings: CaptureSettings = CAPTURE_SETTINGS,
    alignment: AlignmentSettings = ALIGNMENT_SETTINGS,
    foreground: ForegroundSettings = FOREGROUND_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Separate the actor from each room, capture one motion from all and plant the feet.

    Parameters
    ----------
    recordings : sequence of DepthRecording
        With or without the background. The result has the frames of the first.
    body : BodyModel, optional
        By default it is fitted to the recordings.
    motion_prior : MotionPrior, optional
    empty : sequence of int
        Frames of each room without the actor.
    settings : CaptureSettings
    alignment : AlignmentSettings
    foreground : ForegroundSettings
    planting : PlantSettings or None
        None skips planting; so do depth images that all end above the feet.
    on_pose : PoseCallback
        As in `capture_cameras`.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Two recordings are the same or cannot be aligned, or a camera shows no person.
    InvalidSettingError
        The method is one of the published ones.
    SolveCancelled
        Raised by `progress`.
    """
    actors = find_actor_of_cameras(
        recordings, foreground, empty=empty,
        progress=within(progress, 0.0, FOREGROUND_FRACTION),
    )  # fmt: skip
    return capture_seen_actor(
        actors, body, motion_prior=motion_prior, settings=settings, alignment=alignment,
        planting=planting, on_pose=on_pose,
        progress=within(progress, FOREGROUND_FRACTION, 1.0),
    )  # fmt: skip


def find_actor_of_cameras(
    recordings: Sequence[DepthRecording],
    foreground: ForegroundSettings = FOREGROUND_SETTINGS,
    *,
    empty: Sequence[int] = (),
    progress: Progress = unwatched,
) -> tuple[Actor, ...]:
    """Separate the actor from the room before each camera.

    The parameters are those of `capture_from_cameras`.

    Raises
    ------
    InvalidMotionError
        Two recordings are the same, or a camera shows no person.
    """
    check_different(recordings)
    actors = []
    for number, recording in enumerate(recordings):
        part = within(progress, number / len(recordings), (number + 1) / len(recordings))
        with camera_named(number):
            actors.append(find_actor(recording, foreground, empty=empty, progress=part))
    return tuple(actors)


def capture_seen_actor(
    actors: Sequence[Actor],
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    settings: CaptureSettings = CAPTURE_SETTINGS,
    alignment: AlignmentSettings = ALIGNMENT_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Capture one motion of an actor whom several cameras show, and plant the feet.

    The parameters are those of `capture_from_cameras`; `actors` is what each camera shows.
    """
    found = capture_cameras(
        [actor.recording for actor in actors], body, motion_prior=motion_prior,
        floors=[actor.floor for actor in actors], settings=settings, alignment=alignment,
        on_pose=on_pose, progress=within(progress, 0.0, 0.95),
    )  # fmt: skip
    seen_by_all = replace(
        actors[0],
        floor=found.floor,
        feet_visible=any(actor.feet_visible for actor in actors),
    )
    done = finish_capture(
        seen_by_all, found.captured, planting, fitted=body is None,
        progress=within(progress, 0.95, 1.0),
    )  # fmt: skip
    remarks = (*done.remarks, *_camera_remarks(actors, found))
    return replace(done, remarks=remarks, alignments=found.alignments)


def _camera_remarks(actors: Sequence[Actor], found: CapturedByCameras) -> list[str]:
    """Return sentences on the other cameras: their place and time, and their warnings."""
    remarks = []
    for number, (actor, alignment) in enumerate(
        zip(actors[1:], found.alignments[1:], strict=True), start=2
    ):
        distance = float(np.linalg.norm(np.linalg.inv(alignment.camera_from_first)[:3, 3]))
        angle = alignment.angle_to(np.eye(4))
        time, mismatch = abs(alignment.offset), 100.0 * alignment.mismatch
        remarks.append(
            f"Camera {number} is {distance:.2f} m from the first, rotated by {angle:.0f}"
            f" degrees, and began {time:.2f} s later; their skeletons differ by"
            f" {mismatch:.1f} cm."
            if alignment.offset >= 0.0
            else f"Camera {number} is {distance:.2f} m from the first, rotated by {angle:.0f}"
            f" degrees, and began {time:.2f} s earlier; their skeletons differ by"
            f" {mismatch:.1f} cm."
        )
        if alignment.mismatch > MAX_MISMATCH_M:
            remarks.append(f"Check the focal length, scale and frame rate of camera {number}.")
        remarks += [about_camera(number - 1, remark) for remark in actor.remarks]
    return remarks
