"""Capture the motions of several people from one depth recording."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...depth_scene import LEVEL, SeparatedPeople
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched, within
from ..body import BodyModel, MotionPrior, load_motion_prior
from ..capturing import (
    DEFAULT_CAPTURE,
    Capture,
    CaptureSettings,
    Pass,
    TrackingContext,
    assemble_capture,
    best_of_passes,
    check_default_method,
    find_body,
    smooth_poses,
)
from ..forest import PixelForest, load_pixel_forest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, assemble_motion, ignore_pose
from .shared_images import SharedImages
from .track_together import track_together


def capture_people(
    people: SeparatedPeople,
    bodies: Sequence[BodyModel] | None = None,
    forest: PixelForest | None = None,
    motion_prior: MotionPrior | None = None,
    *,
    settings: CaptureSettings = DEFAULT_CAPTURE,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> tuple[Capture, ...]:
    """Capture the motions of all people in a depth recording.

    Each person is captured as by `capture`, but all are tracked together frame by frame. They
    share one depth buffer: a pixel belongs to the nearest predicted body surface, and what
    another person hides is no evidence against a pose. Frames in which a person is absent
    repeat the nearest tracked pose, with confidence 0.

    Parameters
    ----------
    people : SeparatedPeople
        As found by `solvers.depth_scene.find_people`.
    bodies : sequence of BodyModel, optional
        One for each person, in the order of `people`. Default: fitted to the recording.
    on_pose : PoseCallback
        Called with each pose of the first person.
    forest, motion_prior, settings, tracker, progress
        As in `capture`.

    Returns
    -------
    tuple of Capture
        One for each person, in the order of `people`.

    Raises
    ------
    InvalidMotionError
        A person is not detected in any frame, or the number of bodies is wrong.
    InvalidSettingError
        The method is one of the published ones: they track one person.
    SolveCancelled
        Raised by `progress`.
    """
    n_people = len(people.actors)
    check_default_method(settings.method)
    if bodies is not None and len(bodies) != n_people:
        raise InvalidMotionError(f"{len(bodies)} bodies do not match {n_people} people.")
    forest = load_pixel_forest() if forest is None else forest
    callbacks = [on_pose, *[ignore_pose] * (n_people - 1)]
    if motion_prior is None and settings.recorded:
        motion_prior = load_motion_prior()
    body_fraction = 0.0
    if bodies is None:
        body_fraction = 0.4
        bodies = [
            find_body(
                actor.recording, forest, refine=settings.refine, tracker=tracker,
                on_pose=callbacks[index],
                progress=within(
                    progress, body_fraction * index / n_people,
                    body_fraction * (index + 1) / n_people,
                ),
            )
            for index, actor in enumerate(people.actors)
        ]  # fmt: skip
    contexts = [
        TrackingContext(
            people.recording, body, forest, tracker, settings, motion_prior, callback
        )
        for body, callback in zip(bodies, callbacks, strict=True)
    ]
    floor = people.actors[0].floor
    images = SharedImages(
        people.recording, tuple(bodies), people.centers, (floor or LEVEL).up,
        tracker.image_width,
    )  # fmt: skip
    passes = _passes(contexts, images, settings, within(progress, body_fraction, 0.9))
    poses = np.array([
        _best_poses(body, of_person)
        for body, of_person in zip(bodies, zip(*passes, strict=True), strict=True)
    ])
    recordings = images.recordings_of_poses(poses)
    captures = []
    for index, (context, recording) in enumerate(zip(contexts, recordings, strict=True)):
        part = within(
            progress, 0.9 + 0.1 * index / n_people, 0.9 + 0.1 * (index + 1) / n_people
        )
        alone = replace(context, depth=recording)
        smoothed, qualities = smooth_poses(alone, poses[index], settings.smoothing, part)
        tracked = assemble_motion(context.body, smoothed, qualities, recording.frame_rate)
        restarts = passes[0][index].restarts
        captures.append(assemble_capture(context.body, tracked, restarts, floor, settings))
    return tuple(captures)


def _passes(
    contexts: Sequence[TrackingContext],
    images: SharedImages,
    settings: CaptureSettings,
    progress: Progress,
) -> list[list[Pass]]:
    """Return the passes of all people forward, and backward if it is set."""
    n_frames, split = images.recording.n_frames, 0.5 if settings.backward else 1.0
    starts: list[Array | None] = [None] * len(contexts)
    forward = track_together(
        contexts, images, range(n_frames), starts, within(progress, 0.0, split)
    )
    for index, one in enumerate(forward):
        tracked = np.flatnonzero(np.isfinite(one.scores))
        if not len(tracked):
            raise InvalidMotionError(
                f"Person {index + 1} was not detected in any frame. Reduce the number of"
                " people, or check the background settings."
            )
        starts[index] = one.poses[tracked[-1]]
    if not settings.backward:
        return [forward]
    backward = track_together(
        contexts, images, range(n_frames - 1, -1, -1), starts, within(progress, split, 1.0)
    )
    return [forward, backward]


def _best_poses(body: BodyModel, passes: Sequence[Pass]) -> Array:
    frames, pass_indices = best_of_passes(body, passes)
    poses: Array = np.stack([one.poses for one in passes])[pass_indices, frames]
    return poses
