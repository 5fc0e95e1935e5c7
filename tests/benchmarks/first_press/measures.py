"""How near a result is to the truth, and what it lost of the fastest movements."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import Motion, find_humanoid_map, forward_kinematics

from ..shared.noise import angle_error
from .conditions import Case

ENDS = ("leftHand", "rightHand", "leftFoot", "rightFoot")
STROKE_S = 0.25
"""Seconds before and after a turning point over which an end moves out and back."""
MIN_STROKE_M = 0.10
TOLERANCE_S = 0.05
"""Seconds by which a peak may come early or late."""
CENTIMETERS = 100.0


@dataclass(frozen=True)
class TurningPoint:
    """Where a hand or foot goes out and comes back."""

    end: int
    frame: int
    direction: tuple[float, float, float]

    @property
    def label(self) -> str:
        """The end and the frame."""
        return f"{ENDS[self.end]} frame {self.frame}"


@dataclass(frozen=True)
class Figures:
    """The figures of one result; lengths in centimeters, angles in degrees."""

    angle: float
    position: float
    speed_kept: float
    """Fastest speed of hands and feet, relative to the truth's."""
    excursion_loss: float
    worst: TurningPoint | None


def measure(case: Case, motion: Motion) -> Figures:
    """Return the figures; of a missing limb, over its missing samples only."""
    joints: list[int] | NDArray[np.bool_] = case.channels.joints
    scored = frames = slice(case.condition.t_pose_frames, None)
    if case.condition.limb:
        joints, frames = case.missing_joints, case.missing_frames
    angle = float(angle_error(motion, case.truth, joints)[frames].mean())
    truth, estimate = positions_of_ends(case.truth), positions_of_ends(motion)
    position = float(np.linalg.norm(estimate - truth, axis=-1)[frames].mean())
    rate = case.truth.frame_rate
    loss, worst = _excursion_loss(case.truth, motion)
    speeds = _peak_speed(estimate[scored], rate) / _peak_speed(truth[scored], rate)
    speed = float(np.mean(speeds))
    return Figures(angle, CENTIMETERS * position, speed, loss, worst)


def positions_of_ends(motion: Motion) -> Array:
    """Return world positions of hands and feet, shape (n_frames, 4, 3), meters."""
    skeleton = motion.skeleton
    roles = find_humanoid_map(skeleton).joints
    return forward_kinematics(motion).positions[:, [skeleton.index(roles[end]) for end in ENDS]]


def _peak_speed(positions: Array, rate: float) -> Array:
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1)
    return np.asarray(rate * np.maximum(steps.max(axis=0), 1e-6))


def _excursion_loss(truth: Motion, motion: Motion) -> tuple[float, TurningPoint | None]:
    """Return the largest loss of excursion at a turning point, centimeters."""
    rate = truth.frame_rate
    true_path, path = (_about_root(each) for each in (truth, motion))
    near = max(round(TOLERANCE_S * rate), 1)
    worst, where = 0.0, None
    for point in turning_points(truth):
        window = slice(max(point.frame - near, 0), point.frame + near + 1)
        direction = np.array(point.direction)
        reach = (true_path[window, point.end] @ direction).max()
        loss = CENTIMETERS * float(reach - (path[window, point.end] @ direction).max())
        if loss > worst:
            worst, where = loss, point
    return worst, where


def _about_root(motion: Motion) -> Array:
    return positions_of_ends(motion) - motion.root_positions[:, None]


@cache
def turning_points(truth: Motion) -> tuple[TurningPoint, ...]:
    """Return the frames at which hands and feet turn back after a stroke out."""
    path, span = _about_root(truth), max(round(STROKE_S * truth.frame_rate), 1)
    found = []
    for end in range(len(ENDS)):
        x = path[:, end]
        out, back = x[span:-span] - x[: -2 * span], x[span:-span] - x[2 * span :]
        sizes = np.minimum(np.linalg.norm(out, axis=1), np.linalg.norm(back, axis=1))
        reverses = (out * back).sum(axis=1) > 0.5 * np.linalg.norm(
            out, axis=1
        ) * np.linalg.norm(back, axis=1)
        sizes = np.where(reverses, sizes, 0.0)
        while sizes.size and sizes.max() > MIN_STROKE_M:
            index = int(sizes.argmax())
            direction = out[index] + back[index]
            direction /= np.linalg.norm(direction)
            found.append(TurningPoint(end, index + span, tuple(direction)))
            sizes[max(index - span, 0) : index + span + 1] = 0.0
    return tuple(found)
