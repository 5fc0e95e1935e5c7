"""Track a take in one direction, and start again from the detector where the tracker fails."""

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
    FoundPose,
    NextPose,
    OnPose,
    follow,
    has_failed,
    next_pose_prior,
    unobserved,
    unseen,
)

Array = NDArray[np.float64]
Seen = Callable[[int, Array], None]

_YAW = COORDINATES.index("yaw")
_MEMORY = 30
_FREE_WEIGHT = 1.0
"""What little a detected pose holds back its own refinement."""


@dataclass(frozen=True, kw_only=True)
class RecoverySettings(Settings):
    """When the tracker is held to have failed, and what is done."""

    failure_test: FailureTest = setting(
        FailureTest.LEARNED, "How the tracker detects a wrong pose",
    )  # fmt: skip
    failing_chance: float = setting(
        0.5, "Learned probability that a pose is wrong; lower runs the detector more often",
        minimum=0.0, maximum=1.0, label="Failure Probability",
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
    """What one direction found.

    Attributes
    ----------
    poses : shape (n_frames, 36)
    scores : shape (n_frames,)
        Share of pixels that fit; NaN where nobody was seen.
    restarts : tuple of int
        Frames in which a detected pose was taken.
    """

    poses: Array
    scores: Array
    restarts: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Actor:
    """Who is tracked, by which means.

    Attributes
    ----------
    depth : DepthRecording
    body : BodyModel
    forest : PixelForest
    tracker : TrackerSettings
    recovery : RecoverySettings
    motion_prior : MotionPrior or None
    on_pose : OnPose
        Looks on.
    """

    depth: DepthRecording
    body: BodyModel
    forest: PixelForest
    tracker: TrackerSettings
    recovery: RecoverySettings
    motion_prior: MotionPrior | None = None
    on_pose: OnPose = unobserved

    def detected(self, frame: int) -> tuple[Array, FitQuality] | None:
        """Return the pose that the detector finds, refined by the tracker, or None."""
        try:
            found = detect_pose(
                self.depth.frame(frame), self.depth.camera, self.body, self.forest,
                DetectorSettings(),
            )  # fmt: skip
        except InvalidMotionError:
            return None
        weights = np.full(N_COORDINATES, _FREE_WEIGHT)
        weights[:6] = 0.0
        prior = NextPose(found.pose, weights, found.pose)
        observation = observe(self.depth, frame, self.tracker.picture_width)
        pose, quality, _ = follow(self.body, prior, observation, self.tracker)
        return pose, quality


def track_with_restarts(
    actor: Actor,
    order: Iterable[int],
    start: Array | None,
    progress: Progress,
) -> Pass:
    """Track the frames of a take in this order.

    The tracker has failed where a test says so that was learned, or fewer pixels fit than in
    the frames before (or by the thresholds of [WZC12]_ section 5, which depend on the sensor
    and the body: `FailureTest`); then, and every now and again, the detector is asked, and its
    pose is taken if it fits clearly better.

    Parameters
    ----------
    actor : Actor
    order : iterable of int
        Frames, ascending or descending.
    start : shape (36,), optional
        Near the pose in the first of them; without it the detector starts.
    progress : Progress
    """
    frames = list(order)
    poses = np.full((actor.depth.n_frames, N_COORDINATES), np.nan)
    scores = np.full(actor.depth.n_frames, np.nan)
    watch = _Watch(actor.recovery)
    course: list[Array] = [] if start is None else [start]
    restarts, memory = [], None
    for done, frame in enumerate(frames):
        observation = observe(actor.depth, frame, actor.tracker.picture_width)
        score, quality = np.nan, unseen()
        if course and not observation.empty:
            prior = next_pose_prior(course[-2:], actor.tracker, actor.motion_prior)
            pose, quality, memory = follow(
                actor.body, prior, observation, actor.tracker, memory
            )
            score = quality.score
        elif course:
            pose = course[-1]
        if not observation.empty and watch.wants_detection(quality):
            found = actor.detected(frame)
            if found is not None and not found[1].score <= score + actor.recovery.gain:
                turned = _near_turn(found[0], course[-1] if course else found[0])
                if course:
                    restarts.append(frame)
                pose, quality, course, memory = turned, found[1], [], None
                score = quality.score
                watch.recovered()
        if course or np.isfinite(score):
            course.append(pose)
            poses[frame], scores[frame] = pose, score
            actor.on_pose(FoundPose(actor.body, frame, pose, quality))
        watch.note(score)
        progress((done + 1) / len(frames), "Tracking")
    return Pass(poses, scores, tuple(restarts))


class _Watch:
    """Counts frames, and knows how well pixels usually fit."""

    def __init__(self, settings: RecoverySettings) -> None:
        self._settings = settings
        self._usual: deque[float] = deque(maxlen=_MEMORY)
        self._since = settings.check_every

    def wants_detection(self, quality: FitQuality) -> bool:
        """Tell whether it is time to ask the detector."""
        self._since += 1
        settings = self._settings
        failing = has_failed(quality, settings.failure_test, settings.failing_chance)
        if settings.failure_test is FailureTest.LEARNED and self._usual:
            usual = float(np.median(self._usual))
            failing = failing or quality.score < settings.failing_drop * usual
        due = settings.patience if failing else settings.check_every
        if self._since < due:
            return False
        self._since = 0
        return True

    def recovered(self) -> None:
        """Forget how well pixels fitted before."""
        self._usual.clear()

    def note(self, score: float) -> None:
        """Remember the score of a frame."""
        if np.isfinite(score):
            self._usual.append(score)


def _near_turn(pose: Array, before: Array) -> Array:
    """Return the pose with whole turns added so that it goes on from the frame before."""
    turned = pose.copy()
    for place in (_YAW, _YAW + 2):
        turned[place] += 2.0 * np.pi * np.round((before[place] - pose[place]) / (2.0 * np.pi))
    return turned
