"""Smooth the tracked poses of a take by what each of its pictures says."""

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress
from ..body import (
    N_COORDINATES,
    PoseEquations,
    equations_in_coordinates,
    joint_limits,
    natural_stance,
    segment_equations,
    sum_equations,
)
from ..terms import Observation, likelihood_rows, observe, render_hypothesis
from ..tracking import FitQuality, PosePreview, Registered, fit_quality, quality_without_actor
from .passes import TrackingContext
from .smooth_take import smooth_take

Array = NDArray[np.float64]

USUAL_RATE = 30.0
"""Frames per second for which smoothness is given."""
_HOLD = 1e8
_PIECE, _BORDER = 600, 60
"""Frames smoothed at once, and how many of the next piece go along: bounded memory."""


def smoothed_poses(
    actor: TrackingContext, poses: Array, smoothing: float, progress: Progress
) -> tuple[Array, list[FitQuality]]:
    """Return smoothed poses (n_frames, 36), and the figures of each frame."""
    found, figures = poses.copy(), []
    n_frames = len(poses)
    if smoothing > 0.0 and n_frames >= 3:
        for first in range(0, n_frames, _PIECE):
            start, stop = max(0, first - _BORDER), min(n_frames, first + _PIECE + _BORDER)
            smooth = smoothed_piece(actor, poses[start:stop], start, smoothing)
            last = min(first + _PIECE, n_frames)
            found[first:last] = smooth[first - start : last - start]
            progress(0.5 * last / n_frames, "Smoothing")
    for frame in range(n_frames):
        figures.append(measure_fit(actor, found[frame], frame))
        actor.on_pose(PosePreview(actor.body, frame, found[frame], figures[-1]))
        progress(0.5 + 0.5 * (frame + 1) / n_frames, "Judging")
    return found, figures


def smoothed_piece(
    actor: TrackingContext,
    poses: Array,
    first: int,
    smoothing: float,
    held: Collection[int] = (),
) -> Array:
    """Return smoothed poses (n_frames, 36) of a piece of a take.

    Parameters
    ----------
    actor : TrackingContext
    poses : shape (n_frames, 36)
    first : int
        Frame of the recording that is the first of these.
    smoothing : float
        More is smoother.
    held : collection of int
        Of these poses, those that stay.
    """
    tracker = actor.tracker
    # Second differences shrink with the square of the frame rate.
    pace = (actor.depth.frame_rate / USUAL_RATE) ** 4
    stiffness = np.full(N_COORDINATES, smoothing * pace * tracker.turn_weight)
    stiffness[:3] = smoothing * pace * tracker.shift_weight
    equations = []
    for place, pose in enumerate(poses):
        if place in held:
            equations.append((_HOLD * np.eye(N_COORDINATES), np.zeros(N_COORDINATES)))
            continue
        observation = observe(actor.depth, first + place, tracker.picture_width)
        asked = _asked(actor, pose, observation).equations
        equations.append((asked.matrix, asked.vector))
    return smooth_take(poses, equations, stiffness)


def _asked(actor: TrackingContext, pose: Array, observation: Observation) -> Registered:
    """Return what a picture asks of a pose, without what the frames before say."""
    hypothesis = render_hypothesis(actor.body, pose, observation.camera)
    limits = sum_equations([
        joint_limits(pose, actor.tracker.limit_weight),
        natural_stance(pose, 0.0, actor.tracker.ankle_weight),
    ])
    if observation.empty:
        return Registered(hypothesis, limits, 1)
    rows = likelihood_rows(hypothesis, observation, actor.tracker)
    seen: PoseEquations = equations_in_coordinates([segment_equations(rows)], hypothesis.twists)
    return Registered(hypothesis, sum_equations([seen, limits]), 1)


def measure_fit(actor: TrackingContext, pose: Array, frame: int) -> FitQuality:
    """Return how well a pose explains a frame."""
    observation = observe(actor.depth, frame, actor.tracker.picture_width)
    if observation.empty:
        return quality_without_actor()
    found = _asked(actor, pose, observation)
    return fit_quality(actor.body, found, observation, actor.tracker.limit)
