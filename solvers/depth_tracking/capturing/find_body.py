"""Find out how large the actor of a recording is: no reference pose is asked for."""

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched, within
from ..body import BodyModel, default_body
from ..detection import detect_pose
from ..forest import PixelForest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, ignore_pose, offset_frames
from .passes import RecoverySettings, TrackingContext, track_with_restarts
from .refine_body import refine_body

Array = NDArray[np.float64]

STATURES = (1.45, 1.6, 1.75, 1.9)
LOOKED_AT, TRIED = 12, 3
"""Frames whose size is compared, and frames in which statures are tried."""
CLIP = 90
"""Frames that are tracked to refine the body."""


def find_body(
    depth: DepthRecording,
    forest: PixelForest,
    *,
    refine: bool = True,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> BodyModel:
    """Return the usual adult of the stature that fits best, refined by tracking.

    Statures are tried on frames that show most of the actor; the best one is tracked through
    a part of the recording, and its lengths and radii are refined on those poses.

    Parameters
    ----------
    depth : DepthRecording
    forest : PixelForest
    refine : bool
        Without, only the stature is found.
    tracker : TrackerSettings
    on_pose : PoseCallback
        Is shown each pose that is found, as soon as it is.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No frame shows anybody.
    """
    frames = _telling_frames(depth)
    body = _best_stature(depth, forest, frames, within(progress, 0.0, 0.3))
    if not refine:
        return body
    first = int(np.clip(frames[0] - CLIP // 2, 0, max(0, depth.n_frames - CLIP)))
    clip = _part(depth, first, min(CLIP, depth.n_frames - first))
    start, seen_from = None, 0
    for turn in range(2):
        actor = TrackingContext(clip, body, forest, tracker, RecoverySettings(check_every=CLIP),
                      on_pose=offset_frames(on_pose, first))  # fmt: skip
        done = within(progress, 0.3 + 0.35 * turn, 0.65 + 0.35 * turn)
        tracked = track_with_restarts(actor, range(seen_from, clip.n_frames), start, done)
        good = np.flatnonzero(np.isfinite(tracked.scores))
        if not len(good):
            return body
        start, seen_from = tracked.poses[good[0]], int(good[0])
        good = good[tracked.scores[good] >= np.median(tracked.scores[good])]
        chosen = good[np.linspace(0, len(good) - 1, min(24, len(good))).round().astype(int)]
        body = refine_body(clip, body, tracked.poses, frames=chosen, tracker=tracker)
    return body


def _telling_frames(depth: DepthRecording) -> list[int]:
    """Return the frames, of some spread over the recording, that show most surface."""
    places = np.linspace(0, depth.n_frames - 1, min(LOOKED_AT, depth.n_frames))
    frames = np.unique(places.round().astype(int))
    areas = [float(np.square(depth.frame(frame), dtype=np.float64).sum()) for frame in frames]
    best = np.argsort(areas)[::-1][:TRIED]
    return [int(frames[place]) for place in best if areas[place] > 0.0]


def _best_stature(
    depth: DepthRecording, forest: PixelForest, frames: list[int], progress: Progress
) -> BodyModel:
    """Return the usual body that fits best; after one frame the worse half is left out."""
    scores = dict.fromkeys(STATURES, 0.0)
    problem = "No frame shows anybody; check what is taken for background."
    for place, frame in enumerate(frames):
        for stature in scores:
            try:
                pose = detect_pose(
                    depth.frame(frame), depth.camera, default_body(stature), forest
                )
            except InvalidMotionError as error:
                problem = str(error)
                continue
            scores[stature] += pose.score
        if len(scores) == len(STATURES) and any(scores.values()):
            best = sorted(scores, key=lambda stature: scores[stature])[len(STATURES) // 2 :]
            scores = {stature: scores[stature] for stature in best}
        progress((place + 1) / len(frames), "Trying statures")
    if not any(scores.values()):
        raise InvalidMotionError(problem)
    return default_body(max(scores, key=lambda stature: scores[stature]))


def _part(depth: DepthRecording, first: int, n_frames: int) -> DepthRecording:
    return DepthRecording(
        depth.camera, n_frames, depth.frame_rate, lambda frame: depth.frame(first + frame)
    )
