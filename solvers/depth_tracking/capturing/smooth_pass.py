"""Smooth the tracked poses of a take, weighted by the information of each image."""

from collections.abc import Callable, Collection

import numpy as np

from ...arrays import Array
from ...progress import Progress, within
from ..body import (
    N_COORDINATES,
    PoseEquations,
    equations_in_coordinates,
    joint_limits,
    natural_stance,
    segment_equations,
    sum_equations,
)
from ..terms import (
    Observation,
    TrackerSettings,
    likelihood_rows,
    observe,
    render_hypothesis,
)
from ..tracking import FitQuality, PosePreview, Registered, fit_quality, quality_without_actor
from .passes import TrackingContext
from .smooth_take import smooth_take

REFERENCE_RATE_HZ = 30.0
"""Frame rate of the reference for the smoothing weight. By definition."""
_CONSTRAINT_WEIGHT = 1e8
"""Weight per square radian of a pose that must not change. By definition of a constraint, any
value as large gives the same."""
_WINDOW_FRAMES = 600
"""Frames per window; a tenth of them overlaps with each neighbor. It bounds the memory: the
normal equations of a take grow with its length."""
_OVERLAP_FRAMES = _WINDOW_FRAMES // 10


def smooth_poses(
    actor: TrackingContext, poses: Array, smoothing: float, progress: Progress
) -> tuple[Array, list[FitQuality]]:
    """Return smoothed poses (n_frames, 36), and the fit quality of each frame."""
    smoothed, qualities = poses.copy(), []
    n_frames = len(poses)
    if smoothing > 0.0:
        smoothed = smooth_in_windows(
            poses,
            lambda window, first: smooth_window(actor, window, first, smoothing),
            within(progress, 0.0, 0.5),
        )
    for frame in range(n_frames):
        qualities.append(measure_fit(actor, smoothed[frame], frame))
        actor.on_pose(PosePreview(actor.body, frame, smoothed[frame], qualities[-1]))
        progress(0.5 + 0.5 * (frame + 1) / n_frames, "Measuring the fit")
    return smoothed, qualities


def smooth_in_windows(
    poses: Array, smooth: Callable[[Array, int], Array], progress: Progress
) -> Array:
    """Return smoothed poses (n_frames, 36), with the memory of one window.

    Parameters
    ----------
    poses : shape (n_frames, 36)
    smooth : callable
        Maps the poses of a window and their first frame to smoothed poses.
    progress : Progress
    """
    smoothed, n_frames = poses.copy(), len(poses)
    if n_frames < 3:
        return smoothed
    for first in range(0, n_frames, _WINDOW_FRAMES):
        start, stop = (
            max(0, first - _OVERLAP_FRAMES),
            min(n_frames, first + _WINDOW_FRAMES + _OVERLAP_FRAMES),
        )
        window = smooth(poses[start:stop], start)
        last = min(first + _WINDOW_FRAMES, n_frames)
        smoothed[first:last] = window[first - start : last - start]
        progress(last / n_frames, "Smoothing")
    return smoothed


def acceleration_weights(
    tracker: TrackerSettings, smoothing: float, frame_rate: float
) -> Array:
    """Return the weights (36,) of squared second differences of poses."""
    # Second differences shrink with the square of the frame rate.
    rate_factor = (frame_rate / REFERENCE_RATE_HZ) ** 4
    weights = np.full(N_COORDINATES, smoothing * rate_factor * tracker.rotation_weight)
    weights[:3] = smoothing * rate_factor * tracker.shift_weight
    return weights


def smooth_window(
    actor: TrackingContext,
    poses: Array,
    first: int,
    smoothing: float,
    constrained: Collection[int] = (),
) -> Array:
    """Return smoothed poses (n_frames, 36) of a window of a take.

    Parameters
    ----------
    actor : TrackingContext
    poses : shape (n_frames, 36)
    first : int
        Recording frame of the first pose.
    smoothing : float
        Higher is smoother.
    constrained : collection of int
        Indices of poses that stay fixed.
    """
    tracker = actor.tracker
    stiffness = acceleration_weights(tracker, smoothing, actor.depth.frame_rate)
    equations = []
    for index, pose in enumerate(poses):
        if index in constrained:
            equations.append((
                _CONSTRAINT_WEIGHT * np.eye(N_COORDINATES),
                np.zeros(N_COORDINATES),
            ))
            continue
        observation = observe(actor.depth, first + index, tracker.image_width)
        registered = _equations_at_pose(actor, pose, observation).equations
        equations.append((registered.matrix, registered.vector))
    return smooth_take(poses, equations, stiffness)


def _equations_at_pose(
    actor: TrackingContext, pose: Array, observation: Observation
) -> Registered:
    """Return the equations of one image at a pose, without temporal prior."""
    hypothesis = render_hypothesis(actor.body, pose, observation.camera, observation.occluders)
    limits = sum_equations([
        joint_limits(pose, actor.tracker.limit_weight),
        natural_stance(pose, 0.0, actor.tracker.ankle_weight),
    ])
    if observation.empty:
        return Registered(hypothesis, limits, 1)
    rows = likelihood_rows(hypothesis, observation, actor.tracker)
    likelihood: PoseEquations = equations_in_coordinates(
        [segment_equations(rows)], hypothesis.twists
    )
    return Registered(hypothesis, sum_equations([likelihood, limits]), 1)


def measure_fit(actor: TrackingContext, pose: Array, frame: int) -> FitQuality:
    """Return the fit quality of a pose, (36,), in a frame."""
    observation = observe(actor.depth, frame, actor.tracker.image_width)
    if observation.empty:
        return quality_without_actor()
    smoothed = _equations_at_pose(actor, pose, observation)
    return fit_quality(actor.body, smoothed, observation, actor.tracker.limit)
