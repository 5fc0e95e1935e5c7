"""From a depth recording, as it came from the camera, to motion of the actor."""

from collections.abc import Sequence
from dataclasses import dataclass

from ..denoising import Planted, PlantSettings
from ..depth_scene import Actor, DepthRecording, ForegroundSettings, find_actor
from ..depth_tracking.body import BodyModel, MotionPrior
from ..depth_tracking.capturing import Capture, CaptureSettings, capture
from ..depth_tracking.tracking import OnPose, unobserved
from ..motion import Motion
from ..progress import Progress, unwatched, within
from .capture_remarks import capture_remarks
from .plant_feet_if_possible import plant_feet_if_possible

CAPTURING = CaptureSettings()
TELLING = ForegroundSettings()
PLANTING = PlantSettings()
FOREGROUND_FRACTION = 0.1
"""Share of the work after which the actor is told from the room."""


@dataclass(frozen=True, eq=False)
class CapturedMotion:
    """The motion of an actor, and what was done for it.

    Attributes
    ----------
    motion : Motion
        Z up, without gaps; the feet are planted where that was asked for and can be done.
    captured : Capture
    actor : Actor
    planted : Planted or None
    remarks : tuple of str
        Sentences on what the animator should know.
    """

    motion: Motion
    captured: Capture
    actor: Actor
    planted: Planted | None
    remarks: tuple[str, ...]


def capture_recording(
    recording: DepthRecording,
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    empty: Sequence[int] = (),
    settings: CaptureSettings = CAPTURING,
    foreground: ForegroundSettings = TELLING,
    planting: PlantSettings | None = PLANTING,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Tell the actor from the room, capture the motion, and plant the feet.

    Parameters
    ----------
    recording : DepthRecording
        With or without the room.
    body : BodyModel, optional
        Fitted to the recording by default.
    motion_prior : MotionPrior, optional
    empty : sequence of int
        Frames of the room without the actor.
    settings : CaptureSettings
    foreground : ForegroundSettings
    planting : PlantSettings or None
        None leaves the feet as they are; so does a picture that ends above them.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Nobody is seen.
    SolveCancelled
        Raised by `progress`.
    """
    actor = find_actor(
        recording, foreground, empty=empty, progress=within(progress, 0.0, FOREGROUND_FRACTION)
    )
    return capture_actor(
        actor, body, motion_prior=motion_prior, settings=settings, planting=planting,
        progress=within(progress, FOREGROUND_FRACTION, 1.0),
    )  # fmt: skip


def capture_actor(
    actor: Actor,
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    settings: CaptureSettings = CAPTURING,
    planting: PlantSettings | None = PLANTING,
    on_pose: OnPose = unobserved,
    progress: Progress = unwatched,
) -> CapturedMotion:
    """Capture the motion of an actor who was told from the room, and plant the feet.

    Parameters
    ----------
    actor : Actor
    body : BodyModel, optional
    motion_prior : MotionPrior, optional
    settings : CaptureSettings
    planting : PlantSettings or None
    on_pose : OnPose
        Is shown each pose that is found, as soon as it is.
    progress : Progress
    """
    found = capture(
        actor.recording, body, motion_prior=motion_prior, floor=actor.floor,
        settings=settings, on_pose=on_pose, progress=within(progress, 0.0, 0.95),
    )  # fmt: skip
    stands = planting if actor.feet_seen else None
    footing = plant_feet_if_possible(found.motion, stands, progress=within(progress, 0.95, 1.0))
    said = capture_remarks(actor, found, fitted=body is None)
    remarks = (*said, *footing.remarks)
    return CapturedMotion(footing.motion, found, actor, footing.planted, remarks)
