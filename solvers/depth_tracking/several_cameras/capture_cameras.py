"""Capture one motion from the recordings of several depth cameras."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ...depth_scene import DepthRecording, FloorPlane
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched, within
from ..body import BodyModel, MotionPrior, load_motion_prior
from ..capturing import (
    DEFAULT_CAPTURE,
    Capture,
    CaptureSettings,
    capture,
    check_default_method,
    find_body,
)
from ..forest import PixelForest, load_pixel_forest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, ignore_pose
from .align_tracks import (
    DEFAULT_ALIGNMENT,
    FIRST_CAMERA,
    AlignmentSettings,
    CameraAlignment,
    align_tracks,
)
from .capture_views import capture_views, refine_cameras
from .track_views import ViewedActor
from .views import CameraTake


@dataclass(frozen=True, eq=False)
class CapturedByCameras:
    """A motion that several cameras recorded.

    Attributes
    ----------
    captured : Capture
        In the frame and at the frames of the first camera.
    alignments : tuple of CameraAlignment
        One for each camera; the first is the identity.
    alone : tuple of Capture
        What each camera shows by itself, with the same body.
    floor : FloorPlane or None
        That of the first camera that shows one, in the frame of the first camera.
    """

    captured: Capture
    alignments: tuple[CameraAlignment, ...]
    alone: tuple[Capture, ...]
    floor: FloorPlane | None


def capture_cameras(
    recordings: Sequence[DepthRecording],
    body: BodyModel | None = None,
    forest: PixelForest | None = None,
    motion_prior: MotionPrior | None = None,
    *,
    floors: Sequence[FloorPlane | None] = (),
    settings: CaptureSettings = DEFAULT_CAPTURE,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    alignment: AlignmentSettings = DEFAULT_ALIGNMENT,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> CapturedByCameras:
    """Capture the motion of one actor from several static depth cameras.

    Each recording is captured alone, with one body for all. The skeletons calibrate the
    cameras: `align_tracks` finds where and when each one recorded. Then one body is tracked
    through all images. The terms of the tracker stay those of single images [WZC12]_; the
    normal equations of all cameras are summed. Images of other cameras are compared at their
    own times. Each frame starts from the poses of all cameras, and of the frames before and
    after; the poses with the best fit and the smoothest continuation are smoothed together.

    Parameters
    ----------
    recordings : sequence of DepthRecording
        At least two, of any cameras and frame rates; each contains only the actor. The result
        has the frames of the first. Frames that only some cameras show use those.
    body : BodyModel, optional
        Default: the mean of the bodies that are fitted to each recording.
    forest : PixelForest, optional
        Default: the shipped forest.
    motion_prior : MotionPrior, optional
        As in `capture`.
    floors : sequence of FloorPlane or None
        What each camera shows of the floor, in its frame; the first one becomes z = 0.
        Default: the first camera is level.
    settings : CaptureSettings
    tracker : TrackerSettings
    alignment : AlignmentSettings
    on_pose : PoseCallback
        Called with each pose that the first camera shows alone, then with each pose of the
        result.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is detected by a camera, or two recordings cannot be aligned.
    InvalidSettingError
        The method is one of the published ones.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    _check(recordings, settings)
    forest = load_pixel_forest() if forest is None else forest
    if motion_prior is None and settings.recorded:
        motion_prior = load_motion_prior()
    first = 0.0
    if body is None:
        first = 0.3
        part = within(progress, 0.0, first)
        body = _shared_body(recordings, forest, settings, tracker, on_pose, part)
    alone = []
    for number, recording in enumerate(recordings):
        bounds = first + (0.65 - first) * np.array([number, number + 1]) / len(recordings)
        with camera_named(number):
            alone.append(
                capture(recording, body, forest, motion_prior, settings=settings,
                        tracker=tracker, on_pose=ignore_pose if number else on_pose,
                        progress=within(progress, *bounds.tolist()))
            )  # fmt: skip
    alignments = [FIRST_CAMERA]
    for number, other in enumerate(alone[1:], start=1):
        with camera_named(number):
            alignments.append(align_tracks(alone[0].joints, other.joints, settings=alignment))
    cameras = tuple(map(CameraTake, recordings, alignments))
    actor = ViewedActor(cameras, body, tracker, motion_prior, on_pose)
    actor = refine_cameras(actor, alone, within(progress, 0.65, 0.7))
    alignments = [camera.alignment for camera in actor.cameras]
    visible = [
        floor_of_first_camera(floor, each)
        for floor, each in zip(floors, alignments, strict=False)
        if floor is not None
    ]
    floor = visible[0] if visible else None
    captured = capture_views(
        actor, alone, floor=floor, settings=settings, progress=within(progress, 0.7, 1.0)
    )
    return CapturedByCameras(captured, tuple(alignments), tuple(alone), floor)


def floor_of_first_camera(floor: FloorPlane, alignment: CameraAlignment) -> FloorPlane:
    """Return a floor that another camera shows, in the frame of the first camera."""
    rotation, shift = np.split(alignment.camera_from_first[:3], [3], axis=1)
    return FloorPlane(rotation.T @ floor.up, float(floor.heights(shift[:, 0])))


def _check(recordings: Sequence[DepthRecording], settings: CaptureSettings) -> None:
    if len(recordings) < 2:
        raise InvalidMotionError("Several cameras are at least two recordings. Add one.")
    check_default_method(settings.method)


@contextmanager
def camera_named(number: int) -> Iterator[None]:
    """Name the camera in an error about its recording."""
    try:
        yield
    except InvalidMotionError as error:
        raise InvalidMotionError(about_camera(number, str(error))) from error


def about_camera(number: int, sentence: str) -> str:
    """Return a sentence that names the camera, counted from 0, that it is about."""
    return f"Camera {number + 1}: {sentence}"


def _shared_body(
    recordings: Sequence[DepthRecording],
    forest: PixelForest,
    settings: CaptureSettings,
    tracker: TrackerSettings,
    on_pose: PoseCallback,
    progress: Progress,
) -> BodyModel:
    """Return the geometric mean of the bodies that each recording shows."""
    bodies = []
    for number, recording in enumerate(recordings):
        part = within(progress, number / len(recordings), (number + 1) / len(recordings))
        with camera_named(number):
            bodies.append(
                find_body(recording, forest, refine=settings.refine, tracker=tracker,
                          on_pose=ignore_pose if number else on_pose, progress=part)
            )  # fmt: skip
    return BodyModel(
        np.exp(np.mean([np.log(each.lengths) for each in bodies], axis=0)),
        np.exp(np.mean([np.log(each.radii) for each in bodies], axis=0)),
    )
