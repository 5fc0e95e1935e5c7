"""Assemble a result from a cancelled capture."""

from collections.abc import Sequence

import numpy as np

from ...depth_scene import FloorPlane
from ...errors import InvalidMotionError
from ..body import N_COORDINATES
from ..tracking import PosePreview, assemble_motion
from .capture import DEFAULT_CAPTURE, Capture, CaptureSettings, assemble_capture, best_of_passes
from .passes import Pass


def unfinished_capture(
    previews: Sequence[PosePreview],
    frame_rate: float,
    *,
    floor: FloorPlane | None = None,
    settings: CaptureSettings = DEFAULT_CAPTURE,
) -> tuple[int, Capture]:
    """Return the part of a capture that was tracked before it was cancelled.

    Poses of earlier body estimates are ignored. For frames that were tracked repeatedly, as
    by the backward pass, the best fit with the smoothest continuation is selected. The result
    is not smoothed.

    Parameters
    ----------
    previews : sequence of PosePreview
        All previews of `capture`, in order; previews of one body share the object.
    frame_rate : float, hertz
    floor : FloorPlane, optional
    settings : CaptureSettings

    Returns
    -------
    first : int
        Frame of the recording that is the first of the capture.
    capture : Capture
        Without restarts, which are unknown.

    Raises
    ------
    InvalidMotionError
        No pose was tracked yet.
    """
    if not previews:
        raise InvalidMotionError("No pose was tracked yet. Cancel later to keep a result.")
    body = previews[-1].body
    previews = [preview for preview in previews if preview.body is body]
    frames = np.array([preview.frame for preview in previews])
    first, n_frames = int(frames.min()), int(np.ptp(frames)) + 1
    passes: list[dict[int, PosePreview]] = []
    for preview in previews:
        index = preview.frame - first
        n_previous = sum(index in poses_of_frame for poses_of_frame in passes)
        if n_previous == len(passes):
            passes.append({})
        passes[n_previous][index] = preview
    selected = best_of_passes(
        body, [_pass_from_previews(poses_of_frame, n_frames) for poses_of_frame in passes]
    )
    best = [passes[pass_index][frame] for frame, pass_index in zip(*selected, strict=True)]
    tracked = assemble_motion(
        body,
        np.array([preview.pose for preview in best]),
        [preview.quality for preview in best],
        frame_rate,
    )
    return first, assemble_capture(body, tracked, (), floor, settings)


def _pass_from_previews(poses_of_frame: dict[int, PosePreview], n_frames: int) -> Pass:
    poses = np.full((n_frames, N_COORDINATES), np.nan)
    scores = np.full(n_frames, np.nan)
    for frame, preview in poses_of_frame.items():
        poses[frame], scores[frame] = preview.pose, preview.quality.score
    return Pass(poses, scores, ())
