"""What the button Track has solved for it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import PlantSettings
from ...solvers.depth_tracking.capture import CaptureSettings
from ...solvers.motion import Motion
from ...solvers.motion.depth_floor import Floor
from ...solvers.motion.depth_foreground import ForegroundSettings
from ...solvers.motion.depth_recording import DepthRecording
from ...solvers.progress import Progress, unwatched
from ...solvers.workflows import capture_recording


class Doubt(NamedTuple):
    """Frames in which a joint was out of sight or badly explained; the last one counts."""

    joint: str
    first: int
    last: int


class Tracked(NamedTuple):
    """What comes back: the actor's motion, and how far it can be trusted."""

    motion: Motion
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
    progress: Progress = unwatched,
) -> Tracked:
    """Capture a recording."""
    found = capture_recording(
        recording, settings=tracking, foreground=actor, planting=planting, progress=progress
    )
    captured, joints = found.captured, found.captured.joints
    told = joints.confidence
    confidence = {} if told is None else dict(zip(joints.names, told.T, strict=True))
    return Tracked(
        found.motion,
        found.actor.floor,
        confidence,
        captured.residual,
        float(captured.coverage.mean()),
        captured.restarts,
        doubts_of(joints.names, captured.doubtful),
        found.remarks,
    )


def doubts_of(names: tuple[str, ...], doubtful: NDArray[np.bool_]) -> tuple[Doubt, ...]:
    """Return the stretches of frames, the longest first, of flags (n_frames, n_joints)."""
    found = []
    for name, flags in zip(names, doubtful.T, strict=True):
        edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]])))
        found += [
            Doubt(name, int(first), int(stop) - 1)
            for first, stop in zip(edges[::2], edges[1::2], strict=True)
        ]
    return tuple(sorted(found, key=lambda doubt: doubt.first - doubt.last))
