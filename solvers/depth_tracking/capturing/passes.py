"""Track a take in one direction, and restart with the detector after failures."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress
from ..body import COORDINATES, N_COORDINATES, BodyModel, MotionPrior, predict_pose
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
"""Weak weight that keeps the refinement near the detected pose. Half and twice are no better
(`make sensitivity`)."""


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
                DetectorSettings(), occluders=self.depth.occluders(frame),
            )  # fmt: skip
        except InvalidMotionError:
            return None
        prior = prior_near(detection.pose)
        observation = observe(self.depth, frame, self.tracker.image_width)
        terms = self.likelihood(frame, observation, self.body, ())
        return track_frame(self.body, prior, observation, self.tracker, terms)


def prior_near(pose: Array) -> NextPose:
    """Return the weak prior that keeps a refinement near a pose (36,); the hips are free."""
    weights = np.full(N_COORDINATES, _DETECTION_WEIGHT)
    weights[:6] = 0.0
    return NextPose(pose, weights, pose)


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
    tracker = PassTracker(actor, start, policy)
    for done, frame in enumerate(frames):
        tracker.track(frame)
        progress((done + 1) / len(frames), "Tracking")
    return tracker.result()


class PassTracker:
    """Tracks one body in one direction, frame by frame.

    Parameters
    ----------
    actor : TrackingContext
    start : shape (36,), optional
        Near the pose in the first frame. Default: the detector starts.
    policy : RestartPolicy, optional
        Default: `RegularChecks` of `actor.recovery`.
    """

    def __init__(
        self, actor: TrackingContext, start: Array | None, policy: RestartPolicy | None = None
    ) -> None:
        self._actor = actor
        self._policy = policy or RegularChecks(actor.recovery, actor.depth.frame_rate)
        self._trajectory: list[Array] = [] if start is None else [start]
        self._poses = np.full((actor.depth.n_frames, N_COORDINATES), np.nan)
        self._scores = np.full(actor.depth.n_frames, np.nan)
        self._restarts: list[int] = []

    @property
    def last(self) -> Array | None:
        """The last pose, shape (36,), or None before the first."""
        return self._trajectory[-1] if self._trajectory else None

    @property
    def expected(self) -> Array | None:
        """The predicted pose of the next frame, shape (36,), or None before the first."""
        if not self._trajectory:
            return None
        return predict_pose(self._trajectory[-2:], self._actor.tracker.prediction)

    def track(self, frame: int) -> bool:
        """Track the next frame; restart with the detector after a failure.

        Returns
        -------
        bool
            Whether enough of the actor is visible.
        """
        actor, policy, trajectory = self._actor, self._policy, self._trajectory
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
                    self._restarts.append(frame)
                pose, quality, trajectory = unwrapped, detected[1], []
                score = quality.score
                policy.reset()
        if trajectory or np.isfinite(score):
            trajectory.append(pose)
            self._poses[frame], self._scores[frame] = pose, score
            actor.on_pose(PosePreview(actor.body, frame, pose, quality))
        self._trajectory = trajectory
        policy.add_score(score)
        return not observation.empty

    def move(self, displacement: Array) -> None:
        """Move the hips of the last poses, (3,) meters, as while the body is hidden."""
        moved = np.zeros(N_COORDINATES)
        moved[:3] = displacement
        self._trajectory = [pose + moved for pose in self._trajectory[-2:]]

    def forget(self) -> None:
        """Forget the trajectory: the detector finds the body when it appears again."""
        self._trajectory = []

    def result(self) -> Pass:
        """Return what was tracked."""
        return Pass(self._poses, self._scores, tuple(self._restarts))


def unwrap_rotation(pose: Array, before: Array) -> Array:
    """Return the pose, (36,), turned by multiples of 360 degrees to be near the one before."""
    unwrapped = pose.copy()
    for index in (_YAW, _YAW + 2):
        unwrapped[index] += (
            2.0 * np.pi * np.round((before[index] - pose[index]) / (2.0 * np.pi))
        )
    return unwrapped
