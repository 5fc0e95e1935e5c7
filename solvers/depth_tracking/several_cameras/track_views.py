"""Track one body through the images of several cameras."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...progress import Progress
from ..body import (
    N_COORDINATES,
    BodyModel,
    MotionPrior,
    PoseEquations,
    joint_limits,
    natural_stance,
    sum_equations,
)
from ..capturing import (
    Pass,
    acceleration_weights,
    prior_near,
    smooth_in_windows,
    smooth_take,
)
from ..terms import TrackerSettings
from ..tracking import (
    FitQuality,
    PoseCallback,
    PosePreview,
    ignore_pose,
    next_pose_prior,
    quality_without_actor,
)
from .register_views import (
    RegisteredViews,
    image_equations,
    register_views,
    views_quality,
)
from .transfer_poses import continued_rotations
from .views import CameraTake, View, render_view, views_at


@dataclass(frozen=True, eq=False)
class ViewedActor:
    """One actor before several cameras.

    Attributes
    ----------
    cameras : tuple of CameraTake
        The first one defines frame rate, number of frames and the frame of the poses.
    body : BodyModel
    tracker : TrackerSettings
    motion_prior : MotionPrior or None
    on_pose : PoseCallback
        Called with each pose when it is final.
    """

    cameras: tuple[CameraTake, ...]
    body: BodyModel
    tracker: TrackerSettings
    motion_prior: MotionPrior | None = None
    on_pose: PoseCallback = ignore_pose

    @property
    def n_frames(self) -> int:
        """Number of frames of the first camera."""
        return self.cameras[0].depth.n_frames

    @property
    def frame_rate(self) -> float:
        """Frame rate of the first camera, hertz."""
        return self.cameras[0].depth.frame_rate

    def views(self, frame: int, velocity: Array) -> list[View]:
        """Return the images near a frame; `velocity` is the change of the pose in a frame."""
        per_second = velocity * self.frame_rate
        time = frame / self.frame_rate
        return views_at(self.cameras, time, per_second, self.tracker.image_width)

    def quality(self, registered: RegisteredViews, views: list[View]) -> FitQuality:
        """Return the fit of a registered pose in all its images."""
        return views_quality(self.body, registered, views, self.tracker.limit)


def velocities(poses: Array) -> Array:
    """Return the change of poses (n_frames, 36) in a frame; 0 next to missing ones."""
    if len(poses) < 2:
        return np.zeros(poses.shape)
    rates: Array = np.nan_to_num(np.gradient(poses, axis=0))
    return rates


def refine_poses(
    actor: ViewedActor,
    poses: Array,
    progress: Progress,
    frames: Collection[int] | None = None,
) -> Pass:
    """Register given poses to all images, each frame by itself.

    Parameters
    ----------
    actor : ViewedActor
    poses : shape (n_frames, 36)
        NaN: skipped.
    progress : Progress
    frames : collection of int, optional
        Default: all.
    """
    refined = np.full(poses.shape, np.nan)
    scores = np.full(len(poses), np.nan)
    rates = velocities(poses)
    for frame, pose in enumerate(poses):
        progress((frame + 1) / len(poses), "Joining the cameras")
        wanted = np.isfinite(pose).all() and (frames is None or frame in frames)
        views = actor.views(frame, rates[frame]) if wanted else []
        if not views:
            continue
        found = register_views(actor.body, pose, views, prior_near(pose), actor.tracker)
        refined[frame], scores[frame] = found.pose, actor.quality(found, views).score
    return Pass(refined, scores, ())


def track_views(
    actor: ViewedActor,
    order: Iterable[int],
    candidates: Sequence[Pass],
    start: Array | None,
    gain: float,
    progress: Progress,
) -> Pass:
    """Track the frames in the given order, and restart where a candidate fits clearly better.

    Parameters
    ----------
    actor : ViewedActor
    order : iterable of int
        Frames, ascending or descending.
    candidates : sequence of Pass
        Other poses of the same frames.
    start : shape (36,), optional
        Near the pose in the first of the frames. Default: a candidate.
    gain : float
        Improvement of the score required of a candidate.
    progress : Progress
    """
    frames = list(order)
    poses = np.full((actor.n_frames, N_COORDINATES), np.nan)
    scores = np.full(actor.n_frames, np.nan)
    trajectory = [] if start is None else [start]
    restarts = []
    for done, frame in enumerate(frames):
        pose, score = None, -np.inf
        if trajectory:
            pose, score = _tracked(actor, frame, trajectory, frames)
        best = max(candidates, key=lambda each: np.nan_to_num(each.scores[frame], nan=-1.0))
        if np.isfinite(best.scores[frame]) and best.scores[frame] > score + gain:
            if trajectory:
                restarts.append(frame)
            before = trajectory[-1] if trajectory else best.poses[frame]
            pose = continued_rotations(best.poses[frame], before)
            score, trajectory = float(best.scores[frame]), []
        if pose is not None:
            trajectory = [*trajectory[-1:], pose]
            poses[frame], scores[frame] = pose, score
        progress((done + 1) / len(frames), "Tracking")
    return Pass(poses, np.where(np.isfinite(poses[:, 0]), scores, np.nan), tuple(restarts))


def _tracked(
    actor: ViewedActor, frame: int, trajectory: list[Array], frames: list[int]
) -> tuple[Array, float]:
    """Return the pose after those of a trajectory, and its score; NaN without an image."""
    prior = next_pose_prior(trajectory, actor.tracker, actor.motion_prior)
    direction = 1.0 if len(frames) < 2 or frames[1] > frames[0] else -1.0
    views = actor.views(frame, direction * (prior.expected - prior.last))
    if not views:
        return trajectory[-1], np.nan
    found = register_views(actor.body, prior.expected, views, prior, actor.tracker)
    return found.pose, actor.quality(found, views).score


def smooth_views(
    actor: ViewedActor, poses: Array, smoothing: float, progress: Progress
) -> Array:
    """Return smoothed poses (n_frames, 36), weighted by the information of all images."""
    if smoothing == 0.0:
        return poses
    stiffness = acceleration_weights(actor.tracker, smoothing, actor.frame_rate)
    rates = velocities(poses)

    def smooth(window: Array, first: int) -> Array:
        equations = []
        for frame, pose in enumerate(window, start=first):
            views = actor.views(frame, rates[frame])
            found = _equations_at_pose(actor, pose, views)
            equations.append((found.matrix, found.vector))
        return smooth_take(window, equations, stiffness)

    return smooth_in_windows(poses, smooth, progress)


def _equations_at_pose(actor: ViewedActor, pose: Array, views: list[View]) -> PoseEquations:
    """Return the equations of all images at a pose, without temporal prior."""
    images = [render_view(actor.body, pose, view) for view in views]
    return sum_equations([
        *image_equations(images, views, actor.tracker),
        joint_limits(pose, actor.tracker.limit_weight),
        natural_stance(pose, 0.0, actor.tracker.ankle_weight),
    ])


def measure_views(actor: ViewedActor, poses: Array, progress: Progress) -> list[FitQuality]:
    """Return the fit of poses (n_frames, 36) in all images of each frame."""
    qualities, rates = [], velocities(poses)
    for frame, pose in enumerate(poses):
        views, quality = actor.views(frame, rates[frame]), quality_without_actor()
        if views:
            images = tuple(render_view(actor.body, pose, view) for view in views)
            equations = _equations_at_pose(actor, pose, views)
            quality = actor.quality(RegisteredViews(images[0], equations, 1, images), views)
        qualities.append(quality)
        actor.on_pose(PosePreview(actor.body, frame, pose, quality))
        progress((frame + 1) / len(poses), "Measuring the fit")
    return qualities
