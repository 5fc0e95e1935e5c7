"""Solve of the button Track: find the actor in depth images, and track the body."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import (
    DepthRecording,
    FloorPlane,
    ForegroundSettings,
    find_actor,
    find_people,
)
from ...solvers.depth_tracking.body import BodyModel
from ...solvers.depth_tracking.capturing import Capture, CaptureSettings, unfinished_capture
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched, within
from ...solvers.signals import find_runs
from ...solvers.workflows import capture_actor, capture_separated_people
from .pose_previews import (
    FloorPreview,
    ObjectNumber,
    PosePreviewReceiver,
    PosePreviewSender,
    Show,
    no_preview,
)

ACTOR_FRACTION = 0.1
"""Fraction of the progress for the separation of the actor from the room."""


class LowConfidenceRange(NamedTuple):
    """Frames, the last included, where a joint is hidden or fits badly."""

    joint: str
    first: int
    last: int


class FoundCamera(NamedTuple):
    """Where and when another camera recorded."""

    object_number: ObjectNumber
    first_from_camera: NDArray[np.float64]
    """Transform to the frame of the first camera, shape (4, 4), meters."""
    offset: float
    """Time of the first camera at which this one recorded its frame 0, seconds."""
    mismatch: float
    """Median distance of the joints of both skeletons, meters."""
    shows_floor: bool


class Tracked(NamedTuple):
    """Motion of the actor with its confidence."""

    first: int
    """Index of the depth image at the start of the motion."""
    motion: Motion
    body: BodyModel
    floor: FloorPlane | None
    confidence: dict[str, NDArray[np.float64]]
    """Of each joint, shape (n_frames,), 0 to 1."""
    residual: NDArray[np.float64]
    """Meters, shape (n_frames,); NaN where no actor was detected."""
    coverage: float
    restarts: tuple[int, ...]
    low_confidence: tuple[LowConfidenceRange, ...]
    """The longest first."""
    remarks: tuple[str, ...]
    person: int | None = None
    """Index of the person in the recording; None if only one was tracked."""
    images_per_frame: float = 1.0
    """Images of the recording from one frame of the motion to the next."""
    others: tuple[Any, ...] = ()
    """The other people, each `Tracked`."""
    other_numbers: tuple[ObjectNumber, ...] = ()
    """The points of the other cameras that were solved."""
    cameras: tuple[FoundCamera, ...] = ()
    """The other cameras; none if the solve was stopped."""
    first_shows_floor: bool = True
    """Whether the floor is that of the first camera, where there are others."""


def track_recording(
    recording: DepthRecording,
    tracking: CaptureSettings,
    actor: ForegroundSettings,
    planting: PlantSettings | None,
    all_people: bool = False,
    *,
    show: Show = no_preview,
    progress: Progress = unwatched,
) -> Tracked:
    """Capture a recording; send previews of floor and poses to a `PosePreviewReceiver`.

    With `all_people` the others are in the result, and the poses are those of the first person.
    """
    if all_people:
        return _track_people(recording, tracking, actor, planting, show, progress)
    actor_only = find_actor(recording, actor, progress=within(progress, 0.0, ACTOR_FRACTION))
    show(FloorPreview(actor_only.floor))
    done = capture_actor(
        actor_only,
        settings=tracking,
        planting=planting,
        on_pose=PosePreviewSender(show),
        progress=within(progress, ACTOR_FRACTION, 1.0),
    )
    return build_tracked(0, done.motion, done.captured, actor_only.floor, done.remarks)


def _track_people(
    recording: DepthRecording,
    tracking: CaptureSettings,
    actor: ForegroundSettings,
    planting: PlantSettings | None,
    show: Show,
    progress: Progress,
) -> Tracked:
    people = find_people(recording, actor, progress=within(progress, 0.0, ACTOR_FRACTION))
    floor = people.actors[0].floor
    show(FloorPreview(floor))
    captured = capture_separated_people(
        people,
        settings=tracking,
        planting=planting,
        on_pose=PosePreviewSender(show),
        progress=within(progress, ACTOR_FRACTION, 1.0),
    )
    first, *others = (
        build_tracked(0, done.motion, done.captured, floor, done.remarks)._replace(person=index)
        for index, done in enumerate(captured)
    )
    return first._replace(others=tuple(others))


def partial_result(
    previews: Iterable[Any],
    recording: DepthRecording,
    settings: CaptureSettings,
) -> Tracked:
    """Return the result of a stopped `track_recording`, without planted feet.

    Of several cameras, it is the motion before the first, whose `recording` is given.

    Raises InvalidMotionError if no pose was found yet.
    """
    receiver = PosePreviewReceiver()
    poses = list(receiver.poses(previews))
    rate, floor = recording.frame_rate, receiver.floor
    first, captured = unfinished_capture(poses, rate, floor=floor, settings=settings)
    n_frames = captured.motion.n_frames
    remark = (
        f"Stopped early: {n_frames} of {recording.n_frames} frames tracked."
        if n_frames < recording.n_frames
        else "Stopped after the last frame: feet were not planted."
    )
    remarks = [remark]
    if receiver.others:
        remarks.append("The cameras were not joined: this is the motion before the first.")
    tracked = build_tracked(first, captured.motion, captured, floor, tuple(remarks))
    return tracked._replace(other_numbers=receiver.others)


def build_tracked(
    first: int,
    motion: Motion,
    captured: Capture,
    floor: FloorPlane | None,
    remarks: tuple[str, ...],
) -> Tracked:
    """Return the result of a capture whose motion starts at the depth image `first`."""
    joints = captured.joints
    columns = joints.confidence
    confidence = {} if columns is None else dict(zip(joints.names, columns.T, strict=True))
    return Tracked(
        first,
        motion,
        captured.body,
        floor,
        confidence,
        captured.residual,
        captured.mean_coverage,
        captured.restarts,
        low_confidence_ranges(joints.names, captured.low_confidence),
        remarks,
    )


def mean_cm(residual: NDArray[np.float64]) -> float | None:
    """Return the mean of a residual in centimeters; None if no actor was detected."""
    observed = residual[np.isfinite(residual)]
    return 100.0 * float(observed.mean()) if len(observed) else None


def low_confidence_ranges(
    names: tuple[str, ...], mask: NDArray[np.bool_]
) -> tuple[LowConfidenceRange, ...]:
    """Return the intervals of flags (n_frames, n_joints), the longest first."""
    ranges = []
    for name, flags in zip(names, mask.T, strict=True):
        ranges += [
            LowConfidenceRange(name, first, stop - 1) for first, stop in find_runs(flags)
        ]
    return tuple(sorted(ranges, key=lambda interval: interval.first - interval.last))
