"""Track a take in one direction, and restart with the detector after failures."""

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress
from ...settings import Settings, setting
from ..body import COORDINATES, N_COORDINATES, BodyModel, MotionPrior
from ..detection import DetectorSettings, detect_pose
from ..forest import PixelForest
from ..terms import TrackerSettings, observe
from ..tracking import (
    FailureTest,
    FitQuality,
    NextPose,
    PoseCallback,
    PosePreview,
    has_failed,
    ignore_pose,
    next_pose_prior,
    quality_without_actor,
    track_frame,
)

_YAW = COORDINATES.index("yaw")
_DETECTION_WEIGHT = 1.0
"""Weak weight that keeps the refinement near the detected pose. Chosen by hand;
`make sensitivity` varies it."""


@dataclass(frozen=True, kw_only=True)
class RecoverySettings(Settings):
    """Settings of the failure test and of the restarts."""

    failure_test: FailureTest = setting(
        FailureTest.LEARNED, "Choose how the tracker detects a wrong pose",
    )  # fmt: skip
    failing_chance: float = setting(
        0.5, "Learned probability that a pose is wrong; lower runs the detector more often",
        minimum=0.0, maximum=1.0, label="Failure Chance",
    )  # fmt: skip
    failing_drop: float = setting(
        0.9,
        "Fraction of the typical fit below which a pose is wrong",
        minimum=0.0,
        maximum=1.0,
        label="Failure Drop",
    )
    gain: float = setting(
        0.03, "Improvement in fit required of a detected pose; higher prefers the tracker",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    patience: int = setting(
        5, "Frames between detector runs while the tracker fails; higher is faster",
        minimum=1, maximum=1000,
    )  # fmt: skip
    check_every: int = setting(
        15, "Frames between routine detector runs; higher is faster",
        minimum=1, maximum=100_000,
    )  # fmt: skip


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
    """

    depth: DepthRecording
    body: BodyModel
    forest: PixelForest
    tracker: TrackerSettings
    recovery: RecoverySettings
    motion_prior: MotionPrior | None = None
    on_pose: PoseCallback = ignore_pose

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
        return track_frame(self.body, prior, observation, self.tracker)


def track_with_restarts(
    actor: TrackingContext,
    order: Iterable[int],
    start: Array | None,
    progress: Progress,
) -> Pass:
    """Track the frames of a take in the given order.

    The tracker has failed if the learned test reports it, or if the score drops relative to
    the previous frames. Alternatively the thresholds of [WZC12]_ section 5 apply, which depend
    on the sensor and the body (`FailureTest`). After a failure, and at regular intervals, the
    detector runs. Its pose replaces the tracked one if the score is clearly better.

    Parameters
    ----------
    actor : TrackingContext
    order : iterable of int
        Frames, ascending or descending.
    start : shape (36,), optional
        Near the pose in the first of them. Default: the detector starts.
    progress : Progress
    """
    frames = list(order)
    poses = np.full((actor.depth.n_frames, N_COORDINATES), np.nan)
    scores = np.full(actor.depth.n_frames, np.nan)
    policy = _RestartPolicy(actor.recovery, actor.depth.frame_rate)
    trajectory: list[Array] = [] if start is None else [start]
    restarts = []
    for done, frame in enumerate(frames):
        observation = observe(actor.depth, frame, actor.tracker.image_width)
        score, quality = np.nan, quality_without_actor()
        if trajectory and not observation.empty:
            prior = next_pose_prior(trajectory[-2:], actor.tracker, actor.motion_prior)
            pose, quality = track_frame(actor.body, prior, observation, actor.tracker)
            score = quality.score
        elif trajectory:
            pose = trajectory[-1]
        if not observation.empty and policy.should_detect(quality):
            detected = actor.detected(frame)
            if detected is not None and not detected[1].score <= score + actor.recovery.gain:
                unwrapped = _unwrap_rotation(
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


class _RestartPolicy:
    """Decides when the detector runs, from the scores of the last second."""

    def __init__(self, settings: RecoverySettings, frame_rate: float) -> None:
        self._settings = settings
        self._previous_scores: deque[float] = deque(maxlen=max(round(frame_rate), 1))
        self._frames_since_detection = settings.check_every

    def should_detect(self, quality: FitQuality) -> bool:
        """Return whether to run the detector now."""
        self._frames_since_detection += 1
        settings = self._settings
        failing = has_failed(quality, settings.failure_test, settings.failing_chance)
        if settings.failure_test is FailureTest.LEARNED and self._previous_scores:
            typical = float(np.median(self._previous_scores))
            failing = failing or quality.score < settings.failing_drop * typical
        interval = settings.patience if failing else settings.check_every
        if self._frames_since_detection < interval:
            return False
        self._frames_since_detection = 0
        return True

    def reset(self) -> None:
        """Discard the previous scores."""
        self._previous_scores.clear()

    def add_score(self, score: float) -> None:
        """Store the score of a frame."""
        if np.isfinite(score):
            self._previous_scores.append(score)


def _unwrap_rotation(pose: Array, before: Array) -> Array:
    """Return the pose with multiples of 360 degrees added, continuous with the frame before."""
    unwrapped = pose.copy()
    for index in (_YAW, _YAW + 2):
        unwrapped[index] += (
            2.0 * np.pi * np.round((before[index] - pose[index]) / (2.0 * np.pi))
        )
    return unwrapped
