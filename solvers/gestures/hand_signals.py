"""Where the hands are, as the actor sees it, frame by frame as the frames come in."""

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion.humanoid import POSTURE_JOINTS
from .settings import GestureSettings

Array = NDArray[np.float64]

RIGHT = tuple(
    POSTURE_JOINTS.index(f"right{part}") for part in ("UpperArm", "LowerArm", "Hand", "HandEnd")
)
LEFT = tuple(
    POSTURE_JOINTS.index(f"left{part}") for part in ("UpperArm", "LowerArm", "Hand", "HandEnd")
)
HEAD, HIPS = POSTURE_JOINTS.index("head"), POSTURE_JOINTS.index("hips")
NEEDED = (*RIGHT[:3], *LEFT[:3])
SAMPLES = 3
"""Seen samples of each joint whose median counts: one wild sample moves nothing."""
N_LENGTHS = 60
"""Frames whose median tells how long the arms are."""
TURNED_WITHIN = 0.3
"""Seconds within which the actor's heading follows the shoulders."""
SHORTEST_ARM = 0.1
"""Metres. No actor has shorter ones; a tracker that says so sees none."""


@dataclass(frozen=True, eq=False)
class Hands:
    """Both hands at one moment: to the actor's right, forward, up; in arm lengths."""

    time: float
    """Seconds."""
    right: Array
    """The right wrist from its shoulder, shape (3,)."""
    left: Array
    between: Array
    """The middle of the wrists from the middle of the shoulders."""
    gap: float
    """From hand to hand."""
    sideways: float
    """How far the right wrist is to the right of the left one."""
    newest_gap: float
    """From wrist to wrist as last seen, unsteadied; NaN while either is not seen."""

    @property
    def reach(self) -> float:
        """How far the right wrist is from its shoulder: 1 with a straight arm."""
        return float(np.linalg.norm(self.right))


class HandReader:
    """Turns joints into `Hands`: steadied, and free of the actor's place, heading and size."""

    def __init__(self, settings: GestureSettings) -> None:
        self._settings = settings
        self._samples: list[deque[Array]] = [deque(maxlen=SAMPLES) for _ in POSTURE_JOINTS]
        self._seen_at = np.full(len(POSTURE_JOINTS), -np.inf)
        self._lengths: deque[float] = deque(maxlen=N_LENGTHS)
        self._across = np.zeros(2)
        self._time = -np.inf

    def read(self, time: float, positions: Array, confidence: Array) -> Hands | None:
        """Return where the hands are, or None while shoulders or arms are not seen.

        Parameters
        ----------
        time : float, seconds
            Later than that of all frames before.
        positions : shape (20, 3), metres, Z up
            In the order of `POSTURE_JOINTS`; NaN: not tracked.
        confidence : shape (20,), 0 to 1
        """
        seen = np.isfinite(positions).all(axis=-1)
        seen &= confidence >= self._settings.least_confidence
        for joint in np.flatnonzero(seen):
            if time - self._seen_at[joint] > self._settings.patience:
                self._samples[joint].clear()
            self._samples[joint].append(positions[joint])
        self._seen_at[seen] = time
        known = time - self._seen_at <= self._settings.patience
        elapsed, self._time = time - self._time, time
        if not known[list(NEEDED)].all():
            return None
        joints = {joint: self._steady(joint) for joint in (*RIGHT, *LEFT) if known[joint]}
        length = self._arm_length(joints)
        if length < SHORTEST_ARM or not self._turn(joints, elapsed):
            return None
        return self._hands(time, joints, length)

    def _steady(self, joint: int) -> Array:
        return np.asarray(np.median(np.stack(self._samples[joint]), axis=0))

    def _newest_gap(self, time: float) -> float:
        right, left = RIGHT[2], LEFT[2]
        if min(self._seen_at[right], self._seen_at[left]) < time:
            return float("nan")
        return float(np.linalg.norm(self._samples[right][-1] - self._samples[left][-1]))

    def _arm_length(self, joints: dict[int, Array]) -> float:
        for shoulder, elbow, wrist, _ in (RIGHT, LEFT):
            upper = np.linalg.norm(joints[elbow] - joints[shoulder])
            self._lengths.append(float(upper + np.linalg.norm(joints[wrist] - joints[elbow])))
        return float(np.median(self._lengths))

    def _turn(self, joints: dict[int, Array], elapsed: float) -> bool:
        """Follow the shoulders with the heading; tell whether there is one."""
        across = (joints[RIGHT[0]] - joints[LEFT[0]])[:2]
        share = 1.0 if not self._across.any() else 1.0 - np.exp(-elapsed / TURNED_WITHIN)
        self._across = self._across + share * (across - self._across)
        return bool(np.linalg.norm(self._across) > 0.2 * SHORTEST_ARM)

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
