"""Track a body through a depth recording, frame by frame, from an initial pose."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
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
from ..terms import DEFAULT_TRACKER, Observation, TrackerSettings, likelihood_rows, observe
from .fit_quality import FitQuality, fit_quality, quality_without_actor
from .register_pose import Likelihood, register_pose

FrameLikelihood = Callable[[int, Observation, BodyModel, Sequence[Array]], Likelihood]
"""Maps a frame, its observation, the body and the poses before it to the image terms."""


def all_terms(
    frame: int, observation: Observation, body: BodyModel, poses: Sequence[Array]
) -> Likelihood:
    """Return the terms of the settings: the same for all frames."""
    return likelihood_rows


@dataclass(frozen=True, eq=False)
class TrackedMotion:
    """The tracked pose of every frame.

    Attributes
    ----------
    poses : shape (n_frames, 36)
        Coordinates in the order of `COORDINATES`; meters and radians, camera frame.
    joints : Tracks
        The `JOINTS`, named by humanoid roles, in the camera frame (x right, y down,
        z forward), with the confidence of each joint and frame.
    residual : shape (n_frames,), meters
        Mean distance in depth where body and actor overlap; NaN without an actor.
    coverage : shape (n_frames,)
        Intersection over union of the pixels of body and actor.
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
    likelihood: FrameLikelihood = all_terms,
    progress: Progress = unwatched,
) -> TrackedMotion:
    """Track a body from its pose in the first frame.

    `register_pose` registers each frame, starting from the pose predicted from the previous
    frames. This function does not recover from failures; `capture` does. The depth images
    must contain only the actor.

    Parameters
    ----------
    depth : DepthRecording
    body : BodyModel
    initial_pose : shape (36,)
        Near the pose in frame 0.
    motion_prior : MotionPrior, optional
        Recorded motions; each pose is pulled toward the successors of similar poses.
    settings : TrackerSettings
    likelihood : FrameLikelihood
        The image terms. Default: those of `settings`.
    progress : Progress

    Returns
    -------
    TrackedMotion
        A frame without an actor keeps the predicted pose, with confidence 0.

    Raises
    ------
    InvalidMotionError
        The initial pose has a wrong shape or NaN.
    SolveCancelled
        Raised by `progress`.
    """
    poses, qualities = [checked_pose(initial_pose)], []
    for frame in range(depth.n_frames):
        observation = observe(depth, frame, settings.image_width)
        previous = poses[1:] or poses
        prior = next_pose_prior(previous, settings, motion_prior)
        terms = likelihood(frame, observation, body, previous)
        pose, quality = track_frame(body, prior, observation, settings, terms)
        poses.append(pose)
        qualities.append(quality)
        progress((frame + 1) / depth.n_frames, "Tracking")
    return assemble_motion(body, np.array(poses[1:]), qualities, depth.frame_rate)


def checked_pose(pose: Array) -> Array:
    """Return a pose (36,) in float64; refuse a wrong shape and NaN."""
    pose = np.asarray(pose, dtype=np.float64)
    if pose.shape != (N_COORDINATES,) or not np.isfinite(pose).all():
        raise InvalidMotionError(f"A pose needs {N_COORDINATES} finite coordinates.")
    return pose


@dataclass(frozen=True, eq=False)
class NextPose:
    """The prior of the next pose, from the previous frames.

    Attributes
    ----------
    expected : shape (36,)
    weights : shape (36,)
        Weights of the deviation from `expected`.
    last : shape (36,)
        The pose of the previous frame.
    similar : LocalPca or None
        Local model of the successors of similar poses.
    similar_weight : float
    """

    expected: Array
    weights: Array
    last: Array
    similar: LocalPca | None = None
    similar_weight: float = 0.0

    def __call__(self, pose: Array) -> PoseEquations:
        """Return the prior equations at a pose."""
        temporal = stay_near(pose, self.expected, self.weights)
        if self.similar is None:
            return temporal
        return sum_equations([temporal, self.similar.equations(pose, self.similar_weight)])


def next_pose_prior(
    poses: list[Array], settings: TrackerSettings, motion_prior: MotionPrior | None = None
) -> NextPose:
    """Return the prior of the next pose from the poses (36,) of the previous frames."""
    weights = np.full(N_COORDINATES, settings.rotation_weight)
    weights[:3] = settings.shift_weight
    similar = None if motion_prior is None else local_pca(motion_prior, poses[-1])
    expected = predict_pose(poses, settings.prediction)
    return NextPose(expected, weights, poses[-1], similar, settings.similar_weight)


def track_frame(
    body: BodyModel,
    prior: NextPose,
    observation: Observation,
    settings: TrackerSettings,
    likelihood: Likelihood = likelihood_rows,
) -> tuple[Array, FitQuality]:
    """Track one frame, starting near the expected pose.

    Returns the pose (36,) and its fit quality.
    """
    if observation.empty:
        return prior.expected, quality_without_actor()
    start = prior.expected if settings.start_ahead else prior.last
    registered = register_pose(body, start, observation, prior, settings, likelihood)
    return registered.pose, fit_quality(body, registered, observation, settings.limit)


def assemble_motion(
    body: BodyModel, poses: Array, qualities: list[FitQuality], frame_rate: float
) -> TrackedMotion:
    """Assemble the poses, (n_frames, 36), and the fit qualities of all frames."""
    positions = joint_positions(body, segment_frames(body, poses))
    confidence = np.array([quality.confidence for quality in qualities])
    return TrackedMotion(
        poses,
        Tracks(JOINTS, positions, frame_rate, confidence),
        np.array([quality.residual for quality in qualities]),
        np.array([quality.coverage for quality in qualities]),
    )
