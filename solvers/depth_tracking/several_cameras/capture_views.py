"""Join what several cameras show alone: refine their alignment, and track one body."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Array
from ...depth_scene import FloorPlane
from ...progress import Progress, unwatched, within
from ..body import N_COORDINATES
from ..capturing import (
    DEFAULT_CAPTURE,
    Capture,
    CaptureSettings,
    Pass,
    assemble_capture,
    best_of_passes,
)
from ..tracking import assemble_motion
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
