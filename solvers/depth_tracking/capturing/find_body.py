"""Estimate the body size of an actor without a reference pose."""

import numpy as np

from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...motion.humanoid import ADULT_STATURE_M
from ...progress import Progress, unwatched, within
from ..body import BodyModel, default_body
from ..detection import detect_pose, score_body
from ..forest import PixelForest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, ignore_pose, offset_frames
from .passes import TrackingContext, track_with_restarts
from .refine_body import refine_body
from .restart_policies import RecoverySettings

STATURES_M = (1.45, 1.6, 1.75, 1.9)
"""Statures in meters that are tried. Half is worse (`make sensitivity`), and twice is no
stature."""
N_SIZE_FRAMES, N_STATURE_FRAMES = 12, 3
"""Number of frames compared by visible surface, and of frames used to test statures. They bound
the run time."""
CLIP_FRAMES = 90
"""Number of frames tracked to refine the body, three seconds of a depth camera. It bounds the
run time."""


def find_body(
    depth: DepthRecording,
    forest: PixelForest,
    *,
    refine: bool = True,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> BodyModel:
    """Return a body of the best stature, refined by tracking.

    Statures are tested on the frames with the largest visible surface. The best body is
    tracked through a clip of the recording, and its lengths and radii are refined on those
    poses.

    Parameters
    ----------
    depth : DepthRecording
    forest : PixelForest
    refine : bool
        False estimates only the stature.
    tracker : TrackerSettings
    on_pose : PoseCallback
        Called with each pose as soon as it is tracked.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is detected in any frame.
    """
    frames = _largest_frames(depth)
    body = _best_stature(depth, forest, frames, within(progress, 0.0, 0.3))
    if not refine:
        return body
    first = int(np.clip(frames[0] - CLIP_FRAMES // 2, 0, max(0, depth.n_frames - CLIP_FRAMES)))
    clip = _clip_recording(depth, first, min(CLIP_FRAMES, depth.n_frames - first))
    start, first_visible = None, 0
    for pass_ in range(2):
        recovery = RecoverySettings(check_every=CLIP_FRAMES)
        actor = TrackingContext(clip, body, forest, tracker, recovery,
                      on_pose=offset_frames(on_pose, first))  # fmt: skip
        part_progress = within(progress, 0.3 + 0.35 * pass_, 0.65 + 0.35 * pass_)
        tracked = track_with_restarts(
            actor, range(first_visible, clip.n_frames), start, part_progress
        )
        fitted_frames = np.flatnonzero(np.isfinite(tracked.scores))
        if not len(fitted_frames):
            return body
        start, first_visible = tracked.poses[fitted_frames[0]], int(fitted_frames[0])
        fitted_frames = fitted_frames[
            tracked.scores[fitted_frames] >= np.median(tracked.scores[fitted_frames])
        ]
        chosen = fitted_frames[
            np
            .linspace(0, len(fitted_frames) - 1, min(24, len(fitted_frames)))
            .round()
            .astype(int)
        ]
        body = refine_body(clip, body, tracked.poses, frames=chosen, tracker=tracker)
    return body


def _largest_frames(depth: DepthRecording) -> list[int]:
    """Return the frames with the largest visible surface, of samples over the recording."""
    positions = np.linspace(0, depth.n_frames - 1, min(N_SIZE_FRAMES, depth.n_frames))
    frames = np.unique(positions.round().astype(int))
    areas = [float(np.square(depth.frame(frame), dtype=np.float64).sum()) for frame in frames]
    best = np.argsort(areas)[::-1][:N_STATURE_FRAMES]
    return [int(frames[index]) for index in best if areas[index] > 0.0]


def _best_stature(
    depth: DepthRecording, forest: PixelForest, frames: list[int], progress: Progress
) -> BodyModel:
    """Return the best default body: the others are scored near the pose of the best so far."""
    scores = dict.fromkeys(STATURES_M, 0.0)
    best = ADULT_STATURE_M
    message = "No person is detected in any frame. Check the background settings."
    for index, frame in enumerate(frames):
        image, occluders = depth.frame(frame), depth.occluders(frame)
        try:
            detected = detect_pose(
                image, depth.camera, default_body(best), forest, occluders=occluders
            )
        except InvalidMotionError as error:
            message = str(error)
            continue
        for stature in STATURES_M:
            if stature == best:
                scores[stature] += detected.score
            else:
                body = default_body(stature)
                scores[stature] += score_body(
                    body, detected, image, depth.camera, occluders=occluders
                )
        best = max(scores, key=lambda stature: scores[stature])
        progress((index + 1) / len(frames), "Trying body sizes")
    if not any(scores.values()):
        raise InvalidMotionError(message)
    return default_body(best)


def _clip_recording(depth: DepthRecording, first: int, n_frames: int) -> DepthRecording:
    return DepthRecording(
        depth.camera, n_frames, depth.frame_rate, lambda frame: depth.frame(first + frame),
        read_occluders=lambda frame: depth.occluders(first + frame),
    )  # fmt: skip
