"""Make the best of what was found before somebody lost patience."""

from collections.abc import Sequence

import numpy as np

from ...depth_scene import Floor
from ...errors import InvalidMotionError
from ..body import N_COORDINATES
from ..tracking import PosePreview, assemble_motion
from .capture import USUAL_CAPTURE, Capture, CaptureSettings, assemble_capture, best_of_passes
from .passes import Pass


def unfinished_capture(
    found: Sequence[PosePreview],
    frame_rate: float,
    *,
    floor: Floor | None = None,
    settings: CaptureSettings = USUAL_CAPTURE,
) -> tuple[int, Capture]:
    """Return what a capture had found when it was given up.

    Poses of an earlier guess of the body are left out. Where frames were found more than once,
    as on the way back, those are taken that fit and go on smoothly; nothing is smoothed.

    Parameters
    ----------
    found : sequence of PosePreview
        All that `capture` had shown, in that order; those of one body share it.
    frame_rate : float, hertz
    floor : Floor, optional
    settings : CaptureSettings

    Returns
    -------
    first : int
        Frame of the recording that is the first of the capture.
    capture : Capture
        Without restarts, which are not known.

    Raises
    ------
    InvalidMotionError
        Nothing was found yet.
    """
    if not found:
        raise InvalidMotionError("No pose was found yet: there is nothing to keep.")
    body = found[-1].body
    found = [one for one in found if one.body is body]
    frames = np.array([one.frame for one in found])
    first, n_frames = int(frames.min()), int(np.ptp(frames)) + 1
    rounds: list[dict[int, PosePreview]] = []
    for one in found:
        place = one.frame - first
        times = sum(place in known for known in rounds)
        if times == len(rounds):
            rounds.append({})
        rounds[times][place] = one
    chosen = best_of_passes(body, [_pass_of(known, n_frames) for known in rounds])
    kept = [rounds[which][frame] for frame, which in zip(*chosen, strict=True)]
    tracked = assemble_motion(
        body,
        np.array([one.pose for one in kept]),
        [one.quality for one in kept],
        frame_rate,
    )
    return first, assemble_capture(body, tracked, (), floor, settings)


def _pass_of(known: dict[int, PosePreview], n_frames: int) -> Pass:
    poses = np.full((n_frames, N_COORDINATES), np.nan)
    scores = np.full(n_frames, np.nan)
    for frame, one in known.items():
        poses[frame], scores[frame] = one.pose, one.quality.score
    return Pass(poses, scores, ())
