"""Follow a body through a depth recording, frame by frame, from a first pose."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...motion import Tracks
from ...progress import Progress, unwatched
from ..body import (
    JOINTS,
    N_COORDINATES,
    BodyModel,
    LocalPca,
    MotionPrior,
    PoseEquations,
    joint_positions,
    local_pca,
    predict_pose,
    segment_frames,
    stay_near,
    sum_equations,
)
from ..terms import DEFAULT_TRACKER, Observation, PreviousFrame, TrackerSettings, observe
from .fit_quality import FitQuality, fit_quality, quality_without_actor
from .register_pose import register_pose

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class TrackedMotion:
    """Where the body was in every frame.

    Attributes
    ----------
    poses : shape (n_frames, 36)
        Coordinates in the order of `COORDINATES`; metres and radians, camera frame.
    joints : Tracks
        The `JOINTS`, named by humanoid roles, in the camera's frame (x right, y down,
        z forward), with the confidence of each joint and frame.
    residual : shape (n_frames,), metres
        Mean distance in depth where body and actor overlap; NaN where nothing was seen.
    coverage : shape (n_frames,)
        Share of the pixels of body or actor that show both.
    """

    poses: Array
    joints: Tracks
    residual: Array
    coverage: Array


def track_pose(
    depth: DepthRecording,
    body: BodyModel,
    initial_pose: Array,
    motion_prior: MotionPrior | None = None,
    *,
    settings: TrackerSettings = DEFAULT_TRACKER,
    progress: Progress = unwatched,
) -> TrackedMotion:
    """Follow a body from its pose in the first frame.

    Each frame starts where the frames before foretell it to be, and is registered by
    `register_pose`. There is no recovery from failures here; `capture` adds it. Depth other
    than the actor's must have been removed.

    Parameters
    ----------
    depth : DepthRecording
    body : BodyModel
    initial_pose : shape (36,)
        Near the pose in frame 0.
    motion_prior : MotionPrior, optional
        Recorded motions; each pose is drawn to what followed the most similar moments.
    settings : TrackerSettings
    progress : Progress

    Returns
    -------
    TrackedMotion
        A frame without an actor keeps the pose foretold, with confidence 0.

    Raises
    ------
    InvalidMotionError
        The pose is none.
    SolveCancelled
        Raised by `progress`.
    """
    pose = np.asarray(initial_pose, dtype=np.float64)
    if pose.shape != (N_COORDINATES,) or not np.isfinite(pose).all():
        raise InvalidMotionError(f"A pose has {N_COORDINATES} coordinates, none of them NaN.")
    poses, figures, memory = [pose], [], None
    for frame in range(depth.n_frames):
        observation = observe(depth, frame, settings.picture_width)
        prior = next_pose_prior(poses[1:] or poses, settings, motion_prior)
        pose, quality, memory = track_frame(body, prior, observation, settings, memory)
        poses.append(pose)
        figures.append(quality)
        progress((frame + 1) / depth.n_frames, "Tracking")
    return assemble_motion(body, np.array(poses[1:]), figures, depth.frame_rate)


@dataclass(frozen=True, eq=False)
class NextPose:
    """What the frames before say about the next pose.

    Attributes
    ----------
    expected : shape (36,)
    weights : shape (36,)
        How much the pose must be as expected.
    last : shape (36,)
        The frame before.
    similar : LocalPca or None
        What followed similar moments.
    similar_weight : float
    """

    expected: Array
    weights: Array
    last: Array
    similar: LocalPca | None = None
    similar_weight: float = 0.0

    def __call__(self, pose: Array) -> PoseEquations:
        """Return what is asked of a pose."""
        near = stay_near(pose, self.expected, self.weights)
        if self.similar is None:
            return near
        return sum_equations([near, self.similar.equations(pose, self.similar_weight)])


def next_pose_prior(
    poses: list[Array], settings: TrackerSettings, motion_prior: MotionPrior | None = None
) -> NextPose:
    """Return what the poses (36,) of the frames before say about the next one."""
    weights = np.full(N_COORDINATES, settings.turn_weight)
    weights[:3] = settings.shift_weight
    similar = None if motion_prior is None else local_pca(motion_prior, poses[-1])
    expected = predict_pose(poses, settings.trust)
    return NextPose(expected, weights, poses[-1], similar, settings.similar_weight)


def track_frame(
    body: BodyModel,
    prior: NextPose,
    observation: Observation,
    settings: TrackerSettings,
    memory: PreviousFrame | None = None,
) -> tuple[Array, FitQuality, PreviousFrame | None]:
    """Find the pose (36,) of one frame, near the one expected.

    Returns it, its figures, and what the next frame should remember of this one.
    """
    if observation.empty:
        return prior.expected, quality_without_actor(), None
    start = prior.expected if settings.start_ahead else prior.last
    found = register_pose(body, start, observation, prior, settings, memory)
    quality = fit_quality(body, found, observation, settings.limit)
    return found.pose, quality, PreviousFrame(found.hypothesis.frames, observation)


def assemble_motion(
    body: BodyModel, poses: Array, figures: list[FitQuality], frame_rate: float
) -> TrackedMotion:
    """Put the poses and figures of all frames together."""
    positions = joint_positions(body, segment_frames(body, poses))
    confidence = np.array([quality.confidence for quality in figures])
    return TrackedMotion(
        poses,
        Tracks(JOINTS, positions, frame_rate, confidence),
        np.array([quality.residual for quality in figures]),
        np.array([quality.coverage for quality in figures]),
    )
