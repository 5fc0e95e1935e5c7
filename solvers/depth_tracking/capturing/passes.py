"""Track a take in one direction, and restart with the detector after failures."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress
from ..body import COORDINATES, N_COORDINATES, BodyModel, MotionPrior
from ..detection import DetectorSettings, detect_pose
from ..forest import PixelForest
from ..terms import Observation, TrackerSettings, observe
from ..tracking import (
    FitQuality,
    FrameLikelihood,
    NextPose,
    PoseCallback,
    PosePreview,
    all_terms,
    ignore_pose,
    next_pose_prior,
    quality_without_actor,
    track_frame,
)
from .restart_policies import RecoverySettings, RegularChecks, RestartPolicy

_YAW = COORDINATES.index("yaw")
_DETECTION_WEIGHT = 1.0
"""Weak weight that keeps the refinement near the detected pose. Chosen by hand;
`make sensitivity` varies it."""


@dataclass(frozen=True, eq=False)
class Pass:
    """Result of tracking in one direction.

    Attributes
    ----------
    poses : shape (n_frames, 36)
    scores : shape (n_frames,)
        Fraction of pixels that fit; NaN without a visible actor.
    restarts : tuple of int
        Frames where a detected pose replaced the tracked one.
    """

    poses: Array
    scores: Array
    restarts: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class TrackingContext:
    """The recording, body and settings of the tracker.

    Attributes
    ----------
    depth : DepthRecording
    body : BodyModel
    forest : PixelForest
    tracker : TrackerSettings
    recovery : RecoverySettings
    motion_prior : MotionPrior or None
    on_pose : PoseCallback
        Called with each tracked pose.
    likelihood : FrameLikelihood
        The image terms; those of `tracker` by default.
    """

    depth: DepthRecording
    body: BodyModel
    forest: PixelForest
    tracker: TrackerSettings
    recovery: RecoverySettings
    motion_prior: MotionPrior | None = None
    on_pose: PoseCallback = ignore_pose
    likelihood: FrameLikelihood = all_terms

    def tracked(
        self, frame: int, observation: Observation, trajectory: list[Array]
    ) -> tuple[Array, FitQuality]:
        """Return the tracked pose of a frame, after the poses of the frames before."""
        prior = next_pose_prior(trajectory[-2:], self.tracker, self.motion_prior)
        terms = self.likelihood(frame, observation, self.body, trajectory[-1:])
        return track_frame(self.body, prior, observation, self.tracker, terms)

    def detected(self, frame: int) -> tuple[Array, FitQuality] | None:
        """Return the detected pose, refined by the tracker, or None."""
        try:
            detection = detect_pose(
                self.depth.frame(frame), self.depth.camera, self.body, self.forest,
                DetectorSettings(),
            )  # fmt: skip
        except InvalidMotionError:
            return None
        weights = np.full(N_COORDINATES, _DETECTION_WEIGHT)
        weights[:6] = 0.0
        prior = NextPose(detection.pose, weights, detection.pose)
        observation = observe(self.depth, frame, self.tracker.image_width)
        terms = self.likelihood(frame, observation, self.body, ())
        return track_frame(self.body, prior, observation, self.tracker, terms)


def track_with_restarts(
    actor: TrackingContext,
    order: Iterable[int],
    start: Array | None,
    progress: Progress,
    policy: RestartPolicy | None = None,
) -> Pass:
    """Track the frames of a take in the given order.

    The policy decides when the detector runs, and whether its pose replaces the tracked one.

    Parameters
    ----------
    actor : TrackingContext
    order : iterable of int
        Frames, ascending or descending.
    start : shape (36,), optional
        Near the pose in the first of them. Default: the detector starts.
    progress : Progress
    policy : RestartPolicy, optional
        Default: `RegularChecks` of `actor.recovery`.
    """
    frames = list(order)
    poses = np.full((actor.depth.n_frames, N_COORDINATES), np.nan)
    scores = np.full(actor.depth.n_frames, np.nan)
    policy = policy or RegularChecks(actor.recovery, actor.depth.frame_rate)
    trajectory: list[Array] = [] if start is None else [start]
    restarts = []
    for done, frame in enumerate(frames):
        observation = observe(actor.depth, frame, actor.tracker.image_width)
        score, quality = np.nan, quality_without_actor()
        if trajectory and not observation.empty:
            pose, quality = actor.tracked(frame, observation, trajectory)
            score = quality.score
        elif trajectory:
            pose = trajectory[-1]
        if not observation.empty and policy.should_detect(quality if trajectory else None):
            detected = actor.detected(frame)
            if detected is not None and policy.accepts(detected[1].score, score):
                unwrapped = unwrap_rotation(
                    detected[0], trajectory[-1] if trajectory else detected[0]
                )
                if trajectory:
                    restarts.append(frame)
                pose, quality, trajectory = unwrapped, detected[1], []
                score = quality.score
                policy.reset()
        if trajectory or np.isfinite(score):
            trajectory.append(pose)
            poses[frame], scores[frame] = pose, score
            actor.on_pose(PosePreview(actor.body, frame, pose, quality))
        policy.add_score(score)
        progress((done + 1) / len(frames), "Tracking")
    return Pass(poses, scores, tuple(restarts))


def unwrap_rotation(pose: Array, before: Array) -> Array:
    """Return the pose with multiples of 360 degrees added, continuous with the frame before."""
    unwrapped = pose.copy()
    for index in (_YAW, _YAW + 2):
        unwrapped[index] += (
            2.0 * np.pi * np.round((before[index] - pose[index]) / (2.0 * np.pi))
        )
    return unwrapped
