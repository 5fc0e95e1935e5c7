"""Capture the motions of several people from a raw depth recording."""

from collections.abc import Sequence

from ...denoising import PlantSettings
from ...depth_scene import DepthRecording, ForegroundSettings, SeparatedPeople, find_people
from ...depth_tracking.body import BodyModel, MotionPrior
from ...depth_tracking.capturing import CaptureSettings
from ...depth_tracking.several_bodies import capture_people
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


def capture_every_person(
    recording: DepthRecording,
    bodies: Sequence[BodyModel] | None = None,
    *,
    n_people: int | None = None,
    motion_prior: MotionPrior | None = None,
    empty: Sequence[int] = (),
    settings: CaptureSettings = CAPTURE_SETTINGS,
    foreground: ForegroundSettings = FOREGROUND_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> tuple[CapturedMotion, ...]:
    """Separate people from the room and from each other, track them together, plant the feet.

    Parameters
    ----------
    recording : DepthRecording
        With or without the background.
    bodies : sequence of BodyModel, optional
        One for each person, the most visible first. Default: fitted to the recording.
    n_people : int, optional
        Default: as many as are visible at once.
    on_pose : PoseCallback
        Called with each pose of the first person.
    motion_prior, empty, settings, foreground, planting, progress
        As in `capture_recording`.

    Returns
    -------
    tuple of CapturedMotion
        One for each person, the most visible first; all in one world.

    Raises
    ------
    InvalidMotionError
        No person is detected, or fewer than `n_people`.
    InvalidSettingError
        The method is one of the published ones: they track one person.
    SolveCancelled
        Raised by `progress`.
    """
    people = find_people(
        recording, foreground, n_people=n_people, empty=empty,
        progress=within(progress, 0.0, FOREGROUND_FRACTION),
    )  # fmt: skip
    return capture_separated_people(
        people, bodies, motion_prior=motion_prior, settings=settings, planting=planting,
        on_pose=on_pose, progress=within(progress, FOREGROUND_FRACTION, 1.0),
    )  # fmt: skip


def capture_separated_people(
    people: SeparatedPeople,
    bodies: Sequence[BodyModel] | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    settings: CaptureSettings = CAPTURE_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> tuple[CapturedMotion, ...]:
    """Track separated people together, and plant their feet.

    The parameters are those of `capture_every_person`.
    """
    captures = capture_people(
        people, bodies, motion_prior=motion_prior, settings=settings, on_pose=on_pose,
        progress=within(progress, 0.0, 0.95),
    )  # fmt: skip
    count = len(captures)
    return tuple(
        finish_capture(
            actor, captured, planting, fitted=bodies is None,
            progress=within(
                progress, 0.95 + 0.05 * index / count, 0.95 + 0.05 * (index + 1) / count
            ),
        )
        for index, (actor, captured) in enumerate(zip(people.actors, captures, strict=True))
    )  # fmt: skip
