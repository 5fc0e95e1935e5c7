"""Where hands, knees and hips bear on the floor, and the goals that hold them in place."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Flags
from ..motion import Motion, WorldPoses
from ..motion.humanoid import HUMAN_LEG_LENGTH_M, HumanoidMap, leg_length
from ..motion_fitting import FittedMotion, Goal
from ..motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowRotation,
    StayInPlace,
    hinge_axis,
    hinge_limit,
)
from .body_supports import SUPPORTS, SupportJoints, find_supports
from .plant_settings import PlantSettings
from .sole import load_shares, measure_standing_heights, smoothed_paths
from .support import Support, resting_steps

SHOULDER_RAD, ELBOW_RAD = np.radians(4.0), np.radians(2.0)
"""Radians by which a shoulder and an elbow may turn. `make sensitivity` varies them. Sweep of
how elbows of bodies on their hands accelerate, relative to the take: 1.03 times. Shoulder: x0.5
makes it 1.12, x2 leaves it. Elbow: x0.5 makes it 1.00 and turns shoulders farther, x2 makes it
1.17."""
WRIST_RAD = np.radians(15.0)
"""Radians of a wrist, whose hand follows its own rotation in the world. Sweep: x0.5 and x2 turn
arms by 0.1 degrees less and more. `make sensitivity` varies it."""
HAND_RAD = np.radians(2.5)
"""Radians of a hand in the world. Sweep: x0.5 makes elbows accelerate 1.04 times, x2 turns arms
by 1.9 degrees in place of 1.2. `make sensitivity` varies it."""
HAND_M = 0.012
"""Meters, for a leg of 0.9 m, by which a wrist may leave its path in contact. Sweep: x0.5 makes
elbows accelerate 1.11 times; `make sensitivity` varies it."""


@dataclass(frozen=True, eq=False)
class LimbContact(Support):
    """How a hand, a knee or the pelvis bears on the floor.

    Its points are those of the limb.

    Attributes
    ----------
    limb : SupportJoints
    """

    limb: SupportJoints


def find_limb_contacts(
    motion: Motion, poses: WorldPoses, humanoid: HumanoidMap, supports: Flags
) -> list[LimbContact]:
    """Return how hands, knees and hips bear on the floor, of those that do at all.

    A pelvis rests on the lowest and slowest points of its surface: as it rolls from the seat to
    the back, the load moves smoothly from one to the next. It may sink, as flesh does: hips
    that keep their height jerk 1.7 times as much where an actor sits down.

    Parameters
    ----------
    motion : Motion
    poses : WorldPoses
        Of the motion.
    humanoid : HumanoidMap
    supports : bool, shape (n_frames, 5)
        When each of `SUPPORTS` is in contact.
    """
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    found = []
    for limb in find_supports(motion.skeleton, humanoid):
        contact = supports[:, SUPPORTS.index(limb.name)]
        if not contact.any():
            continue
        positions = np.stack([point.position(poses) for point in limb.points], axis=1)
        level = np.zeros(len(limb.points))
        if limb.chain:
            level = measure_standing_heights(positions, contact, motion.frame_rate)
        heights, speeds = smoothed_paths(positions, motion.frame_rate)
        load = load_shares(heights - level, speeds, size)
        height = np.sum(load * (positions[..., 2] - level), axis=1)
        steps = resting_steps(height, contact, size)
        if not limb.chain:
            steps[:, 2] = 0.0
        found.append(LimbContact(size, contact, limb.points, load, steps, limb))
    return found


def limb_tolerances(contacts: Sequence[LimbContact]) -> dict[int, float]:
    """Return by how many radians the joints of arms may turn that bear on hands."""
    tolerances = (SHOULDER_RAD, ELBOW_RAD, WRIST_RAD)
    return {
        joint: tolerance
        for contact in contacts
        if contact.limb.is_arm
        for joint, tolerance in zip(contact.limb.chain, tolerances, strict=True)
    }


def elbows(contacts: Sequence[LimbContact]) -> list[int]:
    """Return the elbows of arms that bear on hands."""
    return [contact.limb.chain[1] for contact in contacts if contact.limb.is_arm]


def limb_goals(
    fitted: FittedMotion, contacts: Sequence[LimbContact], settings: PlantSettings, creep: float
) -> list[Goal]:
    """Return what has to stay in place, and what keeps arms as they were recorded.

    `creep` is the distance in meters, for a leg of 0.9 m, that they may move in Max Contact
    Time.
    """
    goals: list[Goal] = []
    for contact in contacts:
        speed = creep * contact.size / settings.hold
        goals.append(StayInPlace(contact.points, contact.step_load, contact.steps, speed))
        if contact.limb.is_arm:
            goals += _arm_goals(fitted, contact)
    return goals


def _arm_goals(fitted: FittedMotion, contact: LimbContact) -> list[Goal]:
    poses, (_, elbow, wrist) = fitted.poses, contact.limb.chain
    weight = np.repeat(contact.contact[:, None].astype(np.float64), 3, axis=1)
    point, tolerance = BonePoint(wrist, np.zeros(3)), HAND_M * contact.size
    goals: list[Goal] = [
        FollowPosition(point, poses.positions[:, wrist], weight, tolerance),
        FollowRotation(wrist, poses.rotations[:, wrist], HAND_RAD),
    ]
    axis = hinge_axis(fitted, elbow, wrist)
    return goals if axis is None else [*goals, hinge_limit(fitted, elbow, wrist, axis, 0.0)]
