"""What the button Track has solved for it."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import PlantSettings
from ...solvers.depth_scene import DepthRecording, Floor, ForegroundSettings, find_actor
from ...solvers.depth_tracking.body import BodyModel
from ...solvers.depth_tracking.capturing import Capture, CaptureSettings, unfinished_capture
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched, within
from ...solvers.signals import find_runs
from ...solvers.workflows import capture_actor
from .pose_previews import Glimpses, Onlooker, Place, Show, unseen

FOUND = 0.1
"""Share of the work after which the actor is told from the room."""


class Doubt(NamedTuple):
    """Frames in which a joint was out of sight or badly explained; the last one counts."""

    joint: str
    first: int
    last: int


class Tracked(NamedTuple):
    """What comes back: the actor's motion, and how far it can be trusted."""

    first: int
    """Picture of the recording with which the motion begins."""
    motion: Motion
    body: BodyModel
    floor: Floor | None
    confidence: dict[str, NDArray[np.float64]]
    """Of each joint, shape (n_frames,), 0 to 1."""
    residual: NDArray[np.float64]
    """Metres, shape (n_frames,); NaN where nobody was seen."""
    coverage: float
    restarts: tuple[int, ...]
    doubts: tuple[Doubt, ...]
    """The longest first."""
    remarks: tuple[str, ...]


def track_recording(
    recording: DepthRecording,
    tracking: CaptureSettings,
    actor: ForegroundSettings,
    planting: PlantSettings | None,
    *,
    show: Show = unseen,
    progress: Progress = unwatched,
) -> Tracked:
    """Capture a recording; show where it is, and each pose, as `Onlooker` understands it."""
    alone = find_actor(recording, actor, progress=within(progress, 0.0, FOUND))
    show(Place(alone.floor))
    done = capture_actor(
        alone,
        settings=tracking,
        planting=planting,
        on_pose=Glimpses(show),
        progress=within(progress, FOUND, 1.0),
    )
    return _told(0, done.motion, done.captured, alone.floor, done.remarks)


def tracked_so_far(
    shown: Iterable[Any], recording: DepthRecording, settings: CaptureSettings
) -> Tracked:
    """Return what `track_recording` had shown when it was ended; no feet are planted.

    Raises InvalidMotionError where no pose was found yet.
    """
    onlooker = Onlooker()
    found = list(onlooker.poses(shown))
    rate, floor = recording.frame_rate, onlooker.floor
    first, captured = unfinished_capture(found, rate, floor=floor, settings=settings)
    n_frames = captured.motion.n_frames
    remark = f"Stopped early: {n_frames} of {recording.n_frames} frames tracked."
    return _told(first, captured.motion, captured, floor, (remark,))


def _told(
    first: int,
    motion: Motion,
    captured: Capture,
    floor: Floor | None,
    remarks: tuple[str, ...],
) -> Tracked:
    joints = captured.joints
    told = joints.confidence
    confidence = {} if told is None else dict(zip(joints.names, told.T, strict=True))
    return Tracked(
        first,
        motion,
        captured.body,
        floor,
        confidence,
        captured.residual,
        float(captured.coverage.mean()),
        captured.restarts,
        doubts_of(joints.names, captured.doubtful),
        remarks,
    )


def mean_cm(residual: NDArray[np.float64]) -> float | None:
    """Return the mean of a residual, centimetres; None where nobody was seen at all."""
    known = residual[np.isfinite(residual)]
    return 100.0 * float(known.mean()) if len(known) else None


def doubts_of(names: tuple[str, ...], doubtful: NDArray[np.bool_]) -> tuple[Doubt, ...]:
    """Return the stretches of frames, the longest first, of flags (n_frames, n_joints)."""
    found = []
    for name, flags in zip(names, doubtful.T, strict=True):
        found += [Doubt(name, first, stop - 1) for first, stop in find_runs(flags)]
    return tuple(sorted(found, key=lambda doubt: doubt.first - doubt.last))
