"""Find out when hands, knees and hips bear on the floor."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, Skeleton, WorldPoses, forward_kinematics
from ..motion.humanoid import (
    HUMAN_LEG_LENGTH_M,
    SIDES,
    ContactModel,
    HumanoidMap,
    known_foot_points,
    leg_length,
    measure_feet,
)
from ..motion.skeletons import ground_level
from ..motion_fitting.goals import BonePoint
from ..signals import two_state_probabilities
from .legs import LegJoints
from .pelvis import pelvis_points
from .standing_feet import MIN_CONTACT_S, rests_on_hips, without_short_contacts

LIMBS = ("leftHand", "rightHand", "leftKnee", "rightKnee")
SUPPORTS = (*LIMBS, "hips")
"""Columns of the contacts of hands, knees and hips."""
GROUND_ROLES = (
    "hips",
    "head",
    *(f"{side}{part}" for side in SIDES for part in ("Hand", "LowerLeg")),
)
"""Joints that may be the lowest of a body, next to ankles and toes."""

LEARNED = ContactModel(
    bias=2.18,
    speed_weight=23.9,
    speed=0.512,
    height_weight=78.8,
    height=0.538,
    memory=0.18,
    landing_rate=3.83,
    lift_rate=3.04,
)
"""Learned by `tests/training/learn_contacts.py` from made hands and knees; meters and seconds,
for a leg of 0.9 m."""
MIN_SEAT_HEIGHT = 0.12
"""Height of the lowest joint of the pelvis above the feet, as a ratio to the length of a leg,
below which it bears the body. Chosen by hand: x0.5 holds hands of bodies that lie down and
turns their arms twice as far, x2 lets go of hands while an actor gets down.
`test_hands_of_a_body_that_lies_are_free` fails without it."""


@dataclass(frozen=True)
class SupportJoints:
    """Joints and points of a hand, a knee or the hips that may bear on the floor.

    Attributes
    ----------
    name : str
        One of `SUPPORTS`.
    chain : tuple of int
        Shoulder, elbow and wrist, or hip, knee and ankle; empty for the hips, which move with
        the root.
    points : tuple of BonePoint
        Wrist and knuckles, or the knee twice, or the surface of the pelvis.
    """

    name: str
    chain: tuple[int, ...]
    points: tuple[BonePoint, ...]

    @property
    def is_arm(self) -> bool:
        """Whether the limb bears on its hand."""
        return self.name.endswith("Hand")

    @property
    def is_leg(self) -> bool:
        """Whether the limb bears on its knee."""
        return self.name.endswith("Knee")


def find_supports(skeleton: Skeleton, humanoid: HumanoidMap) -> tuple[SupportJoints, ...]:
    """Return the hands and knees that have a complete arm or leg, and the hips if known."""
    joints = humanoid.indices(skeleton)
    found = []
    for name in LIMBS:
        side, is_hand = name.removesuffix("Hand").removesuffix("Knee"), name.endswith("Hand")
        roles = (
            ("UpperArm", "LowerArm", "Hand") if is_hand else ("UpperLeg", "LowerLeg", "Foot")
        )
        chain = [joints.get(f"{side}{role}") for role in roles]
        if None in chain:
            continue
        upper, middle, end = (joint for joint in chain if joint is not None)
        if middle in skeleton.subtree(upper)[1:] and end in skeleton.subtree(middle)[1:]:
            ends = (end, _knuckles(skeleton, end)) if is_hand else (middle, middle)
            points = tuple(BonePoint(joint, np.zeros(3)) for joint in ends)
            found.append(SupportJoints(name, (upper, middle, end), points))
    if pelvis := pelvis_points(skeleton, humanoid):
        found.append(SupportJoints("hips", (), pelvis))
    return tuple(found)


def _knuckles(skeleton: Skeleton, wrist: int) -> int:
    """Return the child of the wrist that is the farthest from it, or the wrist."""
    children = skeleton.children[wrist]
    lengths = [float(np.linalg.norm(skeleton.offsets[child])) for child in children]
    return children[int(np.argmax(lengths))] if children else wrist


def support_probabilities(motion: Motion, humanoid: HumanoidMap) -> Array:
    """Return the probability that each of `SUPPORTS` bears on the floor, (n_frames, 5).

    The model of feet sees how fast wrist and knuckles (or the knee, or the surface of the
    pelvis) are, and how high above the ground, on which the lowest part of the body rests. A
    hand that swings, or rests on a thigh, is too fast or too high, and so are hips on a chair.
    0 where the part is missing.
    """
    poses = forward_kinematics(motion)
    size = leg_length(motion.skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    ground = _ground(motion, poses, humanoid, size)
    probability = np.zeros((motion.n_frames, len(SUPPORTS)))
    for support in find_supports(motion.skeleton, humanoid):
        path = np.stack([point.position(poses) for point in support.points], axis=1) / size
        evidence = measure_feet(path[:, None], motion.frame_rate, ground).evidence(LEARNED)
        rates = motion.frame_rate, LEARNED.landing_rate, LEARNED.lift_rate
        column = SUPPORTS.index(support.name)
        probability[:, column] = two_state_probabilities(evidence, *rates)[:, 0]
    return probability


def _ground(motion: Motion, poses: WorldPoses, humanoid: HumanoidMap, size: float) -> Array:
    """Return the height of the ground for a leg of 0.9 m, from the lowest part of the body."""
    joints = humanoid.indices(motion.skeleton)
    lowest = [*known_foot_points(motion.skeleton, humanoid).ravel()]
    lowest += [joints[role] for role in GROUND_ROLES if role in joints]
    heights = poses.positions[:, lowest, 2].min(axis=1)
    return ground_level(heights / size, motion.frame_rate)


def detect_supports(motion: Motion, humanoid: HumanoidMap, legs: Sequence[LegJoints]) -> Flags:
    """Return when each of `SUPPORTS` bears on the floor, shape (n_frames, 5).

    Hands and knees of a body that sits or lies touch the floor, but bear little of its weight
    and may move, as its feet.
    """
    contacts = support_probabilities(motion, humanoid) > 0.5
    sits = rests_on_hips(motion, humanoid, legs, MIN_SEAT_HEIGHT)
    contacts[:, : len(LIMBS)] &= ~sits[:, None]
    return without_short_contacts(contacts, MIN_CONTACT_S * motion.frame_rate)
