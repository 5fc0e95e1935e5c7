"""Estimate the hands in the actor's own frame, frame by frame."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..motion.humanoid import POSTURE_JOINTS
from .settings import GestureSettings

RIGHT = tuple(
    POSTURE_JOINTS.index(f"right{part}") for part in ("UpperArm", "LowerArm", "Hand", "HandEnd")
)
LEFT = tuple(
    POSTURE_JOINTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand", "HandEnd")
)
HEAD, HIPS = POSTURE_JOINTS.index("head"), POSTURE_JOINTS.index("hips")
REQUIRED_JOINTS = (*RIGHT[:3], *LEFT[:3])
MEDIAN_SAMPLES = 3
"""Observed samples of each joint whose median is used: a single outlier has no effect. Three is
by definition the smallest number with that effect; `make sensitivity` varies it."""
N_LENGTHS = 60
"""Number of frames, two seconds of a depth camera, whose median gives the arm length. Half and
twice are no better (`make sensitivity`)."""
HEADING_TIME_S = 0.3
"""Time constant in seconds at which the actor's heading follows the shoulders. Without it
UI-PRMD and MSR Action3D have 47 waves less and 33 others. Half and twice are no better
(`make sensitivity`)."""
MIN_ACROSS_RATIO = 0.2
"""Level distance of the shoulders, a ratio to `MIN_ARM_M`, from which it is a heading. Half and
twice are no better (`make sensitivity`)."""
MIN_ARM_M = 0.1
"""Minimum arm length in meters. It guards sensors that report all joints at one point
(`test_joints_in_one_point_give_no_hands`)."""


@dataclass(frozen=True, eq=False)
class Hands:
    """Both hands at one time: to the actor's right, forward, up; in arm lengths."""

    time: float
    """Seconds."""
    right: Array
    """Position of the right wrist from its shoulder, shape (3,)."""
    left: Array
    between: Array
    """Midpoint of the wrists from the midpoint of the shoulders."""
    gap: float
    """Distance of the hands."""
    sideways: float
    """Distance of the right wrist to the right of the left one."""
    latest_gap: float
    """Latest distance of the wrists, unfiltered; NaN while either is missing."""

    @property
    def reach(self) -> float:
        """Distance of the right wrist from its shoulder: 1 for a straight arm."""
        return float(np.linalg.norm(self.right))


class HandEstimator:
    """Convert joints to `Hands`: filtered, without the actor's position, heading and size."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self._samples: list[deque[Array]] = [
            deque(maxlen=MEDIAN_SAMPLES) for _ in POSTURE_JOINTS
        ]
        self._observed_at = np.full(len(POSTURE_JOINTS), -np.inf)
        self._lengths: deque[float] = deque(maxlen=N_LENGTHS)
        self._across = np.zeros(2)
        self._time = -np.inf

    def read(self, time: float, positions: Array, confidence: Array) -> Hands | None:
        """Return the hands, or None while shoulders or arms are missing.

        Parameters
        ----------
        time : float, seconds
            Later than that of all frames before.
        positions : shape (20, 3), meters, Z up
            In the order of `POSTURE_JOINTS`; NaN is missing.
        confidence : shape (20,), 0 to 1
        """
        observed = np.isfinite(positions).all(axis=-1)
        observed &= confidence >= self._settings.min_confidence
        for joint in np.flatnonzero(observed):
            if time - self._observed_at[joint] > self._settings.patience:
                self._samples[joint].clear()
            self._samples[joint].append(positions[joint])
        self._observed_at[observed] = time
        available = time - self._observed_at <= self._settings.patience
        elapsed, self._time = time - self._time, time
        if not available[list(REQUIRED_JOINTS)].all():
            return None
        joints = {
            joint: self._median_position(joint) for joint in (*RIGHT, *LEFT) if available[joint]
        }
        length = self._arm_length(joints)
        if length < MIN_ARM_M or not self._update_heading(joints, elapsed):
            return None
        return self._hands(time, joints, length)

    def _median_position(self, joint: int) -> Array:
        return np.asarray(np.median(np.stack(self._samples[joint]), axis=0))

    def _newest_gap(self, time: float) -> float:
        right, left = RIGHT[2], LEFT[2]
        if min(self._observed_at[right], self._observed_at[left]) < time:
            return float("nan")
        return float(np.linalg.norm(self._samples[right][-1] - self._samples[left][-1]))

    def _arm_length(self, joints: dict[int, Array]) -> float:
        for shoulder, elbow, wrist, _ in (RIGHT, LEFT):
            upper = np.linalg.norm(joints[elbow] - joints[shoulder])
            self._lengths.append(float(upper + np.linalg.norm(joints[wrist] - joints[elbow])))
        return float(np.median(self._lengths))

    def _update_heading(self, joints: dict[int, Array], elapsed: float) -> bool:
        """Filter the heading toward the shoulders'; return whether there is one."""
        across = (joints[RIGHT[0]] - joints[LEFT[0]])[:2]
        gain = 1.0 if not self._across.any() else 1.0 - np.exp(-elapsed / HEADING_TIME_S)
        self._across = self._across + gain * (across - self._across)
        return bool(np.linalg.norm(self._across) > MIN_ACROSS_RATIO * MIN_ARM_M)

    def _hands(self, time: float, joints: dict[int, Array], length: float) -> Hands:
        x, y = self._across / np.linalg.norm(self._across)
        actor_from_world = np.array([[x, y, 0.0], [-y, x, 0.0], [0.0, 0.0, 1.0]]) / length
        right = joints[RIGHT[2]] - joints[RIGHT[0]]
        left = joints[LEFT[2]] - joints[LEFT[0]]
        shoulders = 0.5 * (joints[RIGHT[0]] + joints[LEFT[0]])
        wrists = 0.5 * (joints[RIGHT[2]] + joints[LEFT[2]])
        gaps = [
            float(np.linalg.norm(joints[one] - joints[other]))
            for one, other in zip(RIGHT[2:], LEFT[2:], strict=True)
            if one in joints and other in joints
        ]
        return Hands(
            time,
            actor_from_world @ right,
            actor_from_world @ left,
            actor_from_world @ (wrists - shoulders),
            min(gaps) / length,
            float((actor_from_world @ (joints[RIGHT[2]] - joints[LEFT[2]]))[0]),
            self._newest_gap(time) / length,
        )
