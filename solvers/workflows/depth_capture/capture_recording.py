"""Capture the motion of an actor from a raw depth recording."""

from collections.abc import Sequence
from dataclasses import dataclass

from ...denoising import Planted, PlantSettings
from ...depth_scene import Actor, DepthRecording, ForegroundSettings, find_actor
from ...depth_tracking.body import BodyModel, MotionPrior
from ...depth_tracking.capturing import Capture, CaptureSettings, capture
from ...depth_tracking.several_cameras import CameraAlignment
from ...depth_tracking.tracking import PoseCallback, ignore_pose
from ...motion import Motion
from ...progress import Progress, unwatched, within
from ..planting import plant_feet_if_possible
from .capture_remarks import capture_remarks

CAPTURE_SETTINGS = CaptureSettings()
FOREGROUND_SETTINGS = ForegroundSettings()
PLANT_SETTINGS = PlantSettings()
FOREGROUND_FRACTION = 0.1
"""Fraction of the progress spent on separating the actor from the room."""


@dataclass(frozen=True, eq=False)
class CapturedMotion:
    """The captured motion of an actor and the steps that led to it.

    Attributes
    ----------
    motion : Motion
        Z up, without gaps; feet are planted if requested and possible.
    captured : Capture
    actor : Actor
    planted : Planted or None
    remarks : tuple of str
        Sentences the animator should read.
    alignments : tuple of CameraAlignment
        Where and when each of several cameras recorded; empty for one camera.
    """

    motion: Motion
    captured: Capture
    actor: Actor
    planted: Planted | None
    remarks: tuple[str, ...]
    alignments: tuple[CameraAlignment, ...] = ()


def capture_recording(
    recording: DepthRecording,
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    empty: Sequence[int] = (),
    settings: CaptureSettings = CAPTURE_SETTINGS,
    foreground: ForegroundSettings = FOREGROUND_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Separate the actor from the room, capture the motion and plant the feet.

    Parameters
    ----------
    recording : DepthRecording
        With or without the background.
    body : BodyModel, optional
        By default it is fitted to the recording.
    motion_prior : MotionPrior, optional
    empty : sequence of int
        Frames of the room without the actor.
    settings : CaptureSettings
    foreground : ForegroundSettings
    planting : PlantSettings or None
        None skips planting; so does a depth image that ends above the feet.
    on_pose : OnPose
        Called with each pose as soon as it is tracked.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is detected.
    SolveCancelled
        Raised by `progress`.
    """
    actor = find_actor(
        recording, foreground, empty=empty, progress=within(progress, 0.0, FOREGROUND_FRACTION)
    )
    return capture_actor(
        actor, body, motion_prior=motion_prior, settings=settings, planting=planting,
        on_pose=on_pose, progress=within(progress, FOREGROUND_FRACTION, 1.0),
    )  # fmt: skip


def capture_actor(
    actor: Actor,
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    settings: CaptureSettings = CAPTURE_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Capture the motion of a segmented actor and plant the feet.

    Parameters
    ----------
    actor : Actor
    body : BodyModel, optional
    motion_prior : MotionPrior, optional
    settings : CaptureSettings
    planting : PlantSettings or None
    on_pose : OnPose
        Called with each pose as soon as it is tracked.
    progress : Progress
    """
    captured = capture(
        actor.recording, body, motion_prior=motion_prior, floor=actor.floor,
        settings=settings, on_pose=on_pose, progress=within(progress, 0.0, 0.95),
    )  # fmt: skip
    return finish_capture(
        actor, captured, planting, fitted=body is None, progress=within(progress, 0.95, 1.0)
    )


def finish_capture(
    actor: Actor,
    captured: Capture,
    planting: PlantSettings | None,
    *,
    fitted: bool,
    progress: Progress,
) -> CapturedMotion:
    """Plant the feet of a captured actor, and collect the remarks.

    `fitted` is whether the body was fitted to the recording.
    """
    plant_settings = planting if actor.feet_visible else None
    result = plant_feet_if_possible(captured.motion, plant_settings, progress=progress)
    capture_notes = capture_remarks(actor, captured, fitted=fitted)
    remarks = (*capture_notes, *result.remarks)
    return CapturedMotion(result.motion, captured, actor, result.planted, remarks)
