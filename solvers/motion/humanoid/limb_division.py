"""Divide limbs at the joints that make them most like human limbs."""

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ..skeletons import Skeleton
from .mirrored_limbs import MirroredLimbs

# Lengths of the upper and lower limb as fractions of body height (Drillis & Contini 1966, as
# tabled by Winter 2009, Biomechanics and Motor Control of Human Movement, figure 4.1).
ARM_FRACTIONS = (0.186, 0.146)
LEG_FRACTIONS = (0.245, 0.246)
"""The same fractions for the legs. Winter 2009, figure 4.1."""
SHOULDER_FRACTION = 0.129
"""Distance of the shoulder from the midline, as a fraction of body height (Winter 2009, figure
4.1); collar bones start nearer to it."""
MAX_HAND_FRACTION = 0.13
"""Maximum length from wrist to fingertip (0.108 in Winter 2009, figure 4.1, plus a margin)."""
MAX_FOOT_FRACTION = 0.18
"""Maximum length along the bones from ankle to toes (a foot is 0.152 long in Winter 2009,
figure 4.1)."""
MIN_SPREAD_FRACTION = 0.03
"""Of the height, below which the rest pose is folded up and does not show a direction. Chosen
by hand on the rigs of `tests/solvers/motion`."""
FOOT_MISFIT = 0.25
"""Added to the misfit, the logarithm of a length, of an ankle that ends a leg of four joints or
more, whose last one is rather the toes, and of one after a bone that points away from the leg,
which is the foot. Chosen by hand on the rigs of `tests/solvers/motion`."""
MAX_SHANK_COSINE = 0.7
"""Cosine between a bone and the leg above it, up to which it is a foot. Chosen by hand on the
rigs of `tests/solvers/motion`: 45 degrees; feet stand at 60 to 90 degrees to the shank."""

MAX_HUMAN_ANGLE_DEG = 60.0
"""Between trunk and legs in the rest pose of a person, who stands; animals stand at 90. Chosen
by hand on the rigs of `tests/solvers/motion`."""
ALONG_ONE_AXIS = -np.cos(np.radians(20.0))
"""Cosine between trunk and legs, of 160 degrees, below which both point one way from
the hips: a rest pose of bones along one axis. Chosen by hand on the rigs of
`tests/solvers/motion`."""

TWIST_WORD = re.compile(
    "twist|roll|pitch|yaw|bend|stretch|helper|correct|half|sub|捩", re.IGNORECASE
)
"""Of a helper, or of one axis of a joint, as those of robots."""
NO_LETTERS = re.compile(r"[\W\d_]+")
MIN_BONE_FRACTION = 0.05
"""Of a limb, below which a joint between two others is a helper. Chosen by hand on the rigs of
`tests/solvers/motion`."""


def path_length(skeleton: Skeleton, joints: Sequence[int]) -> float:
    """Return the length along the bones from the first to the last of these joints."""
    return float(np.linalg.norm(skeleton.offsets[list(joints[1:])], axis=1).sum())


def without_end_sites(skeleton: Skeleton, joints: Sequence[int]) -> list[int]:
    """Return these joints without end sites."""
    return [joint for joint in joints if not skeleton.is_end_site(joint)]


def distances_from_midline(skeleton: Skeleton, limbs: MirroredLimbs, side: int) -> Array:
    """Return half the distance of each joint of a limb from its counterpart, (n_joints,)."""
    limb, other = limbs.limbs[side], limbs.limbs[1 - side]
    positions = skeleton.rest_positions
    return np.asarray(np.linalg.norm(positions[limb] - positions[other], axis=1) / 2)


def is_human_angle(cosine: float) -> bool:
    """Whether trunk and legs at this angle stand, or lie along one axis as if folded up."""
    return bool(cosine > np.cos(np.radians(MAX_HUMAN_ANGLE_DEG)) or cosine < ALONG_ONE_AXIS)


def is_folded(skeleton: Skeleton, limbs: MirroredLimbs, height: float) -> bool:
    """Whether both limbs lie in the same place, as where all bones have one direction."""
    spread = distances_from_midline(skeleton, limbs, 0).max()
    return bool(spread < MIN_SPREAD_FRACTION * height)


def rest_directions(
    skeleton: Skeleton, limbs: MirroredLimbs, legs: Sequence[list[int]], height: float
) -> tuple[Array, Array | None]:
    """Return up and forward, (3,) each, in the rest pose; +Z and None if it shows neither.

    Toes are in front of the ankle, and knees in front of the line from hip to ankle.

    Parameters
    ----------
    skeleton : Skeleton
    limbs : both legs
    legs : hip, knee and ankle of each (`divide_leg`)
    height : of the person whose bones are as long, meters
    """
    up, positions = np.array([0.0, 0.0, 1.0]), skeleton.rest_positions
    if is_folded(skeleton, limbs, height) or not all(legs):
        return up, None
    hip, knee, ankle = positions[np.array(legs)].mean(axis=0)
    trunk = positions[limbs.branch] - ankle
    if np.linalg.norm(trunk) > MIN_SPREAD_FRACTION * height:
        up = trunk / np.linalg.norm(trunk)
    tips = positions[[leg[-1] for leg in limbs.limbs]].mean(axis=0)
    ahead = tips - ankle + knee - (hip + ankle) / 2.0
    ahead -= (ahead @ up) * up
    shows_forward = np.linalg.norm(ahead) > MIN_SPREAD_FRACTION * height
    return up, ahead / np.linalg.norm(ahead) if shows_forward else None


def divide_leg(
    skeleton: Skeleton, leg: Sequence[int], height: float
) -> tuple[list[int], float]:
    """Return hip, knee and ankle of a leg, and the misfit of `_divide`."""
    joints = without_end_sites(skeleton, leg)
    excess = _log_excess(skeleton, leg, len(joints), MAX_FOOT_FRACTION * height)
    if len(joints) > 3 and joints[-1] == leg[-1]:
        excess[-1] += FOOT_MISFIT
    if len(joints) > 3:
        excess[3:] += FOOT_MISFIT * _is_foot(skeleton, joints)[3:]
    return _divide(skeleton, joints, LEG_FRACTIONS, height, np.zeros(len(joints)), excess)


def _is_foot(skeleton: Skeleton, joints: Sequence[int]) -> NDArray[np.bool_]:
    """Return for each joint whether its bone points away from the leg above it."""
    positions = skeleton.rest_positions[list(joints)]
    bones = np.diff(positions, axis=0, prepend=positions[:1])
    legs = positions - bones - positions[0]
    along = (bones * legs).sum(axis=1)
    lengths = np.linalg.norm(bones, axis=1) * np.linalg.norm(legs, axis=1)
    return np.asarray((along < MAX_SHANK_COSINE * lengths).astype(bool))


def divide_arm(
    skeleton: Skeleton, arms: MirroredLimbs, side: int, height: float
) -> tuple[list[int], float]:
    """Return shoulder, elbow and wrist of an arm, and the misfit of `_divide`.

    Of several upper joints, the one nearest to the human distance from the midline is
    preferred.
    """
    arm = _without_fingers(skeleton, arms.limbs[side], height)
    joints = without_end_sites(skeleton, arm)
    lateral = dict(
        zip(arms.limbs[side], distances_from_midline(skeleton, arms, side), strict=True)
    )
    across = np.array([lateral[joint] for joint in joints]) / height
    if max(across, default=0.0) < MIN_SPREAD_FRACTION:  # a folded rest pose
        preferences = np.zeros(len(joints))
    else:
        preferences = np.abs(np.log(np.maximum(across, 1e-9) / SHOULDER_FRACTION))
    excess = _log_excess(skeleton, arms.limbs[side], len(joints), MAX_HAND_FRACTION * height)
    return _divide(skeleton, joints, ARM_FRACTIONS, height, preferences, excess)


def _log_excess(skeleton: Skeleton, limb: Sequence[int], n_joints: int, length: float) -> Array:
    """Return by how much what follows each of the first joints exceeds a hand or foot."""
    bones = np.linalg.norm(skeleton.offsets[list(limb)], axis=1)
    beyond = bones[::-1].cumsum()[::-1] - bones
    return np.asarray(np.log(np.maximum(beyond[:n_joints] / length, 1.0)))


def _divide(
    skeleton: Skeleton,
    joints: list[int],
    human: tuple[float, float],
    height: float,
    preferences: Array,
    excess: Array,
) -> tuple[list[int], float]:
    """Return upper joint, hinge and end of a limb, and the misfit.

    The misfit is the sum of both bones' absolute log ratios to human lengths, and of what is
    left beyond the end. A limb needs at least three joints.
    """
    if len(joints) < 3:
        return [], 1.0
    positions = skeleton.rest_positions[joints]
    bones = np.linalg.norm(positions[:, None] - positions, axis=-1) / height
    later = np.triu(np.ones_like(bones, dtype=bool), k=1)
    upper, lower = (
        np.where(later, np.abs(np.log(np.maximum(bones, 1e-9) / length)), np.inf)
        for length in human
    )
    preferred, lower = upper + preferences[:, None], lower + excess
    # Both bones meet at the hinge; given the hinge, each is chosen independently.
    hinge = int((preferred.min(axis=0) + lower.min(axis=1)).argmin())
    start, end = int(preferred[:, hinge].argmin()), int(lower[hinge].argmin())
    misfit = float(upper[start, hinge] + lower[hinge, end])
    return [joints[index] for index in (start, hinge, end)], misfit


def _without_fingers(skeleton: Skeleton, arm: list[int], height: float) -> list[int]:
    """Return the arm up to its last branch, with at least three joints.

    If the rest is longer than a hand, the branch is a twist bone and the arm is complete.
    """
    branches = [i for i, joint in enumerate(arm) if len(skeleton.children[joint]) > 1]
    if not branches or branches[-1] < 2:
        return arm
    is_hand = path_length(skeleton, arm[branches[-1] :]) <= MAX_HAND_FRACTION * height
    return arm[: branches[-1] + 1] if is_hand else arm


def joint_between(skeleton: Skeleton, taken: set[int], upper: int, lower: int) -> int | None:
    """Return a joint without a role between two of a limb, no helper and no twist bone."""
    above = skeleton.ancestors(lower)
    if upper not in above:
        return None
    ends = skeleton.rest_positions[[upper, lower]]
    length = np.linalg.norm(ends[1] - ends[0])
    for joint in above[: above.index(upper)]:
        between = np.linalg.norm(ends - skeleton.rest_positions[joint], axis=1).min()
        if (
            joint not in taken
            and between > MIN_BONE_FRACTION * length
            and not _is_twist(skeleton.names[joint], skeleton.names[upper])
        ):
            return joint
    return None


def _is_twist(name: str, upper: str) -> bool:
    """Whether a joint is called a twist bone, or like the joint above it."""
    return bool(TWIST_WORD.search(name)) or (
        NO_LETTERS.sub("", name).lower() == NO_LETTERS.sub("", upper).lower()
    )


def is_forearm(skeleton: Skeleton, shoulder: int, elbow: int, wrist: int, between: int) -> bool:
    """Whether the forearm up to `wrist` is more human than up to a joint between both."""
    positions = skeleton.rest_positions
    upper = float(np.linalg.norm(positions[elbow] - positions[shoulder]))
    forearms = np.linalg.norm(positions[[wrist, between]] - positions[elbow], axis=1)
    human = ARM_FRACTIONS[1] / ARM_FRACTIONS[0]
    misfits = np.abs(np.log(np.maximum(forearms, 1e-9) / max(upper * human, 1e-9)))
    return bool(misfits[0] < misfits[1])
