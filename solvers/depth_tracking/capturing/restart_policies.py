"""Decide when the detector runs, and whether its pose replaces the tracked one."""

from collections import deque
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...settings import Settings, setting
from ..tracking import FailureTest, FitQuality, has_failed, quality_without_actor


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


class RestartPolicy(Protocol):
    """Decides over the restarts of one pass."""

    def should_detect(self, quality: FitQuality | None) -> bool:
        """Return whether to run the detector in this frame; None: nothing is tracked yet."""

    def accepts(self, detected_score: float, tracked_score: float) -> bool:
        """Return whether a detected pose replaces the tracked one, by their scores."""

    def reset(self) -> None:
        """Begin again with a detected pose."""

    def add_score(self, score: float) -> None:
        """Store the score of a frame; NaN without an actor."""


class RegularChecks:
    """Runs the detector after failures and at intervals; a clearly better score is accepted.

    The tracker has failed if the learned test reports it, or if the score drops relative to the
    last second. Alternatively the thresholds of [WZC12]_ section 5 apply, which depend on the
    sensor and the body (`FailureTest`).

    Parameters
    ----------
    settings : RecoverySettings
    frame_rate : float, hertz

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """

    def __init__(self, settings: RecoverySettings, frame_rate: float) -> None:
        self._settings = settings
        self._previous_scores: deque[float] = deque(maxlen=max(round(frame_rate), 1))
        self._frames_since_detection = settings.check_every

    def should_detect(self, quality: FitQuality | None) -> bool:
        """Return whether to run the detector in this frame; None: nothing is tracked yet."""
        self._frames_since_detection += 1
        settings, quality = self._settings, quality or quality_without_actor()
        failing = has_failed(quality, settings.failure_test, settings.failing_chance)
        if settings.failure_test is FailureTest.LEARNED and self._previous_scores:
            typical = float(np.median(self._previous_scores))
            failing = failing or quality.score < settings.failing_drop * typical
        interval = settings.patience if failing else settings.check_every
        if self._frames_since_detection < interval:
            return False
        self._frames_since_detection = 0
        return True

    def accepts(self, detected_score: float, tracked_score: float) -> bool:
        """Return whether a detected pose replaces the tracked one, by their scores."""
        return not detected_score <= tracked_score + self._settings.gain

    def reset(self) -> None:
        """Discard the previous scores."""
        self._previous_scores.clear()

    def add_score(self, score: float) -> None:
        """Store the score of a frame; NaN without an actor."""
        if np.isfinite(score):
            self._previous_scores.append(score)


class RestartsAfterFailures:
    """Runs the detector in each frame that the tracker fails in, and takes its pose [WZC12]_.

    Parameters
    ----------
    settings : RecoverySettings
    recovers : bool
        False runs the detector only until it finds the first pose, as [LOU12]_ has no other.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6), section 5.
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.6.
    """

    def __init__(self, settings: RecoverySettings, *, recovers: bool) -> None:
        self._settings, self._recovers = settings, recovers

    def should_detect(self, quality: FitQuality | None) -> bool:
        """Return whether to run the detector in this frame; None: nothing is tracked yet."""
        if quality is None:
            return True
        settings = self._settings
        failed = has_failed(quality, settings.failure_test, settings.failing_chance)
        return self._recovers and failed

    def accepts(self, detected_score: float, tracked_score: float) -> bool:
        """Return that a detected pose always replaces the tracked one."""
        return True

    def reset(self) -> None:
        """Do nothing: no frame depends on the ones before."""

    def add_score(self, score: float) -> None:
        """Do nothing: no frame depends on the ones before."""
