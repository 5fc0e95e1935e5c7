"""Capture one motion from the recordings of several depth cameras."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording, FloorPlane
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched, within
from ..body import N_COORDINATES, BodyModel, MotionPrior, load_motion_prior
from ..capturing import Capture, CaptureMethod, CaptureSettings, capture
from ..capturing.capture import DEFAULT_CAPTURE, assemble_capture, best_of_passes
from ..capturing.find_body import find_body
from ..capturing.passes import Pass
from ..forest import PixelForest, load_pixel_forest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, assemble_motion, ignore_pose
from .align_tracks import (
    DEFAULT_ALIGNMENT,
    FIRST_CAMERA,
    AlignmentSettings,
    CameraAlignment,
    align_tracks,
)
from .refine_alignment import frames_to_refine, refine_alignment
from .track_views import (
    ViewedActor,
    measure_views,
    refine_poses,
    smooth_views,
    track_views,
    velocities,
)
from .transfer_poses import continued, poses_at, transfer_poses
from .views import CameraTake

FIT_FRACTION, ALONE_FRACTION, ALIGNED_FRACTION = 0.3, 0.65, 0.7
"""Fractions of the progress after the body, the captures alone, and the alignment."""


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
    """

    captured: Capture
    alignments: tuple[CameraAlignment, ...]
    alone: tuple[Capture, ...]


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
        Called with each pose of the result.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is detected by a camera, or two recordings cannot be aligned.
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
        first = FIT_FRACTION
        part = within(progress, 0.0, first)
        body = _shared_body(recordings, forest, settings, tracker, part)
    alone = []
    for number, recording in enumerate(recordings):
        bounds = first + (ALONE_FRACTION - first) * np.array([number, number + 1]) / len(
            recordings
        )
        with _camera_named(number):
            alone.append(
                capture(recording, body, forest, motion_prior, settings=settings,
                        tracker=tracker, progress=within(progress, *bounds.tolist()))
            )  # fmt: skip
    alignments = [FIRST_CAMERA]
    for number, other in enumerate(alone[1:], start=1):
        with _camera_named(number):
            alignments.append(align_tracks(alone[0].joints, other.joints, settings=alignment))
    cameras = tuple(map(CameraTake, recordings, alignments))
    actor = ViewedActor(cameras, body, tracker, motion_prior, on_pose)
    actor = refine_cameras(actor, alone, within(progress, ALONE_FRACTION, ALIGNED_FRACTION))
    alignments = [camera.alignment for camera in actor.cameras]
    visible = [
        floor_of_first_camera(floor, each)
        for floor, each in zip(floors, alignments, strict=False)
        if floor is not None
    ]
    captured = capture_views(
        actor, alone, floor=visible[0] if visible else None, settings=settings,
        progress=within(progress, ALIGNED_FRACTION, 1.0),
    )  # fmt: skip
    return CapturedByCameras(captured, tuple(alignments), tuple(alone))


def floor_of_first_camera(floor: FloorPlane, alignment: CameraAlignment) -> FloorPlane:
    """Return a floor that another camera shows, in the frame of the first camera."""
    rotation, shift = np.split(alignment.camera_from_first[:3], [3], axis=1)
    return FloorPlane(rotation.T @ floor.up, float(floor.heights(shift[:, 0])))


def _check(recordings: Sequence[DepthRecording], settings: CaptureSettings) -> None:
    if len(recordings) < 2:
        raise InvalidMotionError("Several cameras are at least two recordings. Add one.")
    if settings.method is not CaptureMethod.DEFAULT:
        raise InvalidMotionError(
            "The published methods use one camera. Choose the default method, or one recording."
        )


@contextmanager
def _camera_named(number: int) -> Iterator[None]:
    """Name the camera in an error about its recording."""
    try:
        yield
    except InvalidMotionError as error:
        raise InvalidMotionError(f"Camera {number + 1}: {error}") from error


def _shared_body(
    recordings: Sequence[DepthRecording],
    forest: PixelForest,
    settings: CaptureSettings,
    tracker: TrackerSettings,
    progress: Progress,
) -> BodyModel:
    """Return the geometric mean of the bodies that each recording shows."""
    bodies = []
    for number, recording in enumerate(recordings):
        part = within(progress, number / len(recordings), (number + 1) / len(recordings))
        with _camera_named(number):
            bodies.append(
                find_body(recording, forest, refine=settings.refine, tracker=tracker,
                          progress=part)
            )  # fmt: skip
    return BodyModel(
        np.exp(np.mean([np.log(each.lengths) for each in bodies], axis=0)),
        np.exp(np.mean([np.log(each.radii) for each in bodies], axis=0)),
    )


def refine_cameras(
    actor: ViewedActor, alone: Sequence[Capture], progress: Progress
) -> ViewedActor:
    """Refine the alignments by the images, from the best poses of all cameras."""
    frames = frames_to_refine(actor)
    given = own_poses(actor, alone)
    step = 0.6 / len(given)
    candidates = [
        refine_poses(actor, poses, within(progress, step * number, step * (number + 1)), frames)
        for number, poses in enumerate(given)
    ]
    scores = np.nan_to_num([each.scores for each in candidates], nan=-1.0)
    best = scores.argmax(axis=0)
    poses = {
        frame: candidates[best[frame]].poses[frame]
        for frame in frames
        if scores[best[frame], frame] >= 0.0
    }
    rates = np.stack([velocities(each) for each in given])[best, np.arange(actor.n_frames)]
    return refine_alignment(actor, poses, rates, within(progress, 0.6, 1.0))


def capture_views(
    actor: ViewedActor,
    alone: Sequence[Capture],
    *,
    floor: FloorPlane | None = None,
    settings: CaptureSettings = DEFAULT_CAPTURE,
    progress: Progress = unwatched,
) -> Capture:
    """Track one body through the images of aligned cameras.

    Parameters
    ----------
    actor : ViewedActor
    alone : sequence of Capture
        What each of the cameras shows by itself, with the body of the actor.
    floor : FloorPlane, optional
        In the frame of the first camera.
    settings : CaptureSettings
    progress : Progress
    """
    given = own_poses(actor, alone)
    candidates = [
        refine_poses(
            actor, poses,
            within(progress, 0.5 * number / len(given), 0.5 * (number + 1) / len(given)),
        )
        for number, poses in enumerate(given)
    ]  # fmt: skip
    passes = [*_passes(actor, candidates, settings, within(progress, 0.5, 0.8)), *candidates]
    sources, chosen = best_of_passes(actor.body, passes)
    poses = np.stack([each.poses for each in passes])[chosen, sources]
    poses = continued(poses)
    poses = smooth_views(actor, poses, settings.smoothing, within(progress, 0.8, 0.9))
    qualities = measure_views(actor, poses, within(progress, 0.9, 1.0))
    tracked = assemble_motion(actor.body, poses, qualities, actor.frame_rate)
    return assemble_capture(actor.body, tracked, passes[0].restarts, floor, settings)


def own_poses(actor: ViewedActor, alone: Sequence[Capture]) -> list[Array]:
    """Return what each camera shows by itself, as poses (n_frames, 36) of the first camera.

    NaN where a camera has no image.
    """
    times = np.arange(actor.n_frames) / actor.frame_rate
    found = []
    for camera, own in zip(actor.cameras, alone, strict=True):
        first_from_camera = np.linalg.inv(camera.alignment.camera_from_first)
        moved = transfer_poses(actor.body, own.poses, first_from_camera)
        frames = (times - camera.alignment.offset) * camera.depth.frame_rate
        found.append(poses_at(moved, frames))
    return found


def _passes(
    actor: ViewedActor,
    candidates: Sequence[Pass],
    settings: CaptureSettings,
    progress: Progress,
) -> list[Pass]:
    """Track in both directions, beginning at the frame that the cameras show best.

    There the candidates agree best with all images; frames that fewer cameras show continue
    from it.
    """
    scores = np.nan_to_num([each.scores for each in candidates], nan=-1.0).max(axis=0)
    n_views = [len(actor.views(frame, np.zeros(N_COORDINATES))) for frame in range(len(scores))]
    first = int(np.lexsort((scores, n_views))[-1])
    last = actor.n_frames - 1

    def track(start: int, stop: int, pose: Array | None, fraction: float) -> Pass:
        step = 1 if stop >= start else -1
        order = range(start, stop + step, step)
        part = within(progress, fraction, fraction + 1.0 / 3.0)
        return track_views(actor, order, candidates, pose, settings.gain, part)

    ahead = track(first, last, None, 0.0)
    back = track(last, 0, ahead.poses[last], 1.0 / 3.0)
    again = track(0, first, back.poses[0], 2.0 / 3.0)
    is_ahead = np.arange(actor.n_frames) >= first
    forward = Pass(
        np.where(is_ahead[:, np.newaxis], ahead.poses, again.poses),
        np.where(is_ahead, ahead.scores, again.scores),
        tuple(sorted({*again.restarts, *ahead.restarts})),
    )
    return [forward, back]
