"""Assemble the result of a recording that was tracked while it grew."""

from collections.abc import Sequence

import numpy as np

from ...depth_scene import FloorPlane
from ...errors import InvalidMotionError
from ..body import N_COORDINATES
from ..capturing import DEFAULT_CAPTURE, Capture, CaptureSettings, assemble_capture
from ..tracking import PosePreview, assemble_motion, quality_without_actor


def assemble_followed(
    previews: Sequence[PosePreview],
    frame_rate: float,
    *,
    restarts: Sequence[int] = (),
    floor: FloorPlane | None = None,
    settings: CaptureSettings = DEFAULT_CAPTURE,
) -> tuple[int, Capture]:
    """Return the motion of poses that were tracked in some of the frames.

    Poses of other frames are interpolated, with confidence 0.

    Parameters
    ----------
    previews : sequence of PosePreview
        Of one body, with rising frames.
    frame_rate : float, hertz
    restarts : sequence of int
        Frames where the detector restarted the tracker.
    floor : FloorPlane, optional
    settings : CaptureSettings

    Returns
    -------
    first : int
        Frame of the first pose, which begins the motion.
    capture : Capture

    Raises
    ------
    InvalidMotionError
        There are no poses.
    """
    if not previews:
        raise InvalidMotionError(
            "No pose was tracked: no person was detected, or it ended too early."
        )
    body, first = previews[0].body, previews[0].frame
    tracked = np.array([preview.frame - first for preview in previews])
    n_frames = int(tracked[-1]) + 1
    columns = np.array([preview.pose for preview in previews]).T
    poses = np.empty((n_frames, N_COORDINATES))
    for coordinate, column in enumerate(columns):
        poses[:, coordinate] = np.interp(np.arange(n_frames), tracked, column)
    qualities = [quality_without_actor()] * n_frames
    for frame, preview in zip(tracked.tolist(), previews, strict=True):
        qualities[frame] = preview.quality
    motion = assemble_motion(body, poses, qualities, frame_rate)
    own_restarts = tuple(frame - first for frame in restarts if frame > first)
    return first, assemble_capture(body, motion, own_restarts, floor, settings)
