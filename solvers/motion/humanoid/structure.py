"""Assign humanoid roles to joints by the tree and the lengths of the bones."""

import re
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from itertools import product
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ..skeletons import Skeleton
from .limb_division import (
    MIN_SPREAD_FRACTION,
    divide_arm,
    divide_leg,
    is_folded,
    is_human_angle,
    path_length,
    rest_directions,
    without_end_sites,
)
from .mirrored_limbs import (
    MirroredLimbs,
    are_separate,
    find_mirrored_limbs,
    named_as_other_limb,
)
from .names import split_names

TRUNK_FRACTION = 0.288
"""Of the height, from hips to shoulders (Winter 2009, figure 4.1); arms branch off lower."""
TRUNK_WEIGHT = 0.25
"""Weight of the trunk's length in the misfit of a body. Chosen by hand on the rigs of
`tests/solvers/motion`."""
ROOT_AT_CHEST = 0.5
"""Added to the misfit, the logarithm of a length, of a body whose legs are children of its
chest: more often, legs were taken for arms. Chosen by hand on the rigs of
`tests/solvers/motion`."""
LEG_PATH_FRACTION = 0.6
"""Of the height, from the hip joint along the bones to the tip of the foot. Chosen by hand on
the rigs of `tests/solvers/motion`."""
HEIGHT_FACTORS = np.exp(np.linspace(-0.4, 0.4, 17))
"""Factors of the height that the legs suggest, which are tried: up to 1.5 times either way.
Chosen by hand on the rigs of `tests/solvers/motion`."""
ROUGH_FACTORS = HEIGHT_FACTORS[2::6]
"""Heights that are tried first, of all pairs of limbs."""
N_REFINED = 8
"""Matches whose height is then refined."""
MAX_OTHER_LIMB_FRACTION = 0.6
"""Length, relative to the legs, above which a third pair of limbs is no skirt or hair. Chosen
by hand on the rigs of `tests/solvers/motion`."""
MAX_CACHED = 8
"""Number of cached structures. It bounds the memory. A press uses those of its source and its
target several times."""
LegMisfit = Callable[[tuple[int, ...], float], float]
"""Returns how far a leg is from that of a person of a height."""
FACE_OR_TIP = re.compile(r"end|top|tip|nub|jaw|eye|face|hair|hat|頭先", re.IGNORECASE)
"""Names of what lies beyond the head."""


class Structure(NamedTuple):
    """The roles that tree and lengths suggest."""

    joints: dict[str, str]
    """Joint names by role; empty without two legs."""
    humanness: float
    """Similarity of the proportions to those of a person, 0 to 1."""
    height: float
    """Of the person whose bones are as long, in meters; 0 without two legs."""
    guesses_sides: bool = False
    """Whether neither names nor toes show which side is left."""


class _BestLimbs(NamedTuple):
    """Legs, arms and height that fit best, and their misfit."""

    legs: MirroredLimbs
    arms: MirroredLimbs | None
    height: float
    misfit: float


def roles_by_structure(skeleton: Skeleton) -> Structure:
    """Return joint names by role, and how human the proportions are.

    Legs and arms are two pairs of branches that mirror each other, with the trunk between
    them. Knee and ankle, elbow and wrist are the joints that divide each limb most like a
    human limb. Lengths decide, so that the rest pose may have any axes and even be folded up.
    Sides follow the names, where they have any; else toes and knees show where the rest pose
    faces, or else -Y. A limb whose names are those of an arm is no leg, and reverse. Fingers
    get no role.
    """
    found = _find_structure(skeleton.names, skeleton.parents, skeleton.offsets.tobytes())
    return found._replace(joints=dict(found.joints))  # the cached one stays as it is


@lru_cache(maxsize=MAX_CACHED)
def _find_structure(
    names: tuple[str, ...], parents: tuple[int, ...], offsets: bytes
) -> Structure:
    """Return the structure; cached, since roles and their evidence use that of one skeleton."""
    skeleton = Skeleton(names, parents, np.frombuffer(offsets).reshape(-1, 3))
    pairs = find_mirrored_limbs(skeleton)

    @cache
    def leg_misfit(leg: tuple[int, ...], height: float) -> float:
        """Return the misfit; cached, since each leg is tried with many arms."""
        return divide_leg(skeleton, leg, height)[1]

    words = [split for _, split in split_names(names)]
    legs_of, arms_of = (
        [pair for pair in pairs if not named_as_other_limb(words, pair, limb)]
        for limb in ("Leg", "Arm")
    )
    rough = [
        _match(skeleton, legs, arms, ROUGH_FACTORS, leg_misfit)
        for legs, arms in product(legs_of, (*arms_of, None))
        if arms is None or are_separate(skeleton, legs, arms)
    ]
    if not rough:
        return Structure({}, 0.0, 0.0)
    rough.sort(key=lambda match: match.misfit)
    match = min(
        (
            _match(skeleton, each.legs, each.arms, HEIGHT_FACTORS, leg_misfit)
            for each in rough[:N_REFINED]
        ),
        key=lambda match: match.misfit,
    )
    limbed = _LimbedSkeleton(skeleton, match)
    roles = limbed.roles()
    n_others = _count_other_limbs(skeleton, match, pairs)
    return Structure(
        {role: skeleton.names[joint] for role, joint in roles.items()},
        float(np.exp(-match.misfit)) / (1 + n_others),
        match.height,
        limbed.forward is None and not any(limbed.sides),
    )


def _match(
    skeleton: Skeleton,
    legs: MirroredLimbs,
    arms: MirroredLimbs | None,
    factors: Array,
    leg_misfit: LegMisfit,
) -> _BestLimbs:
    """Return these legs and arms with the height that fits them best."""
    guess = np.mean([path_length(skeleton, leg) for leg in legs.limbs]) / LEG_PATH_FRACTION
    heights = np.maximum(guess, 1e-9) * factors
    misfits = [_misfit(skeleton, legs, arms, height, leg_misfit) for height in heights]
    best = int(np.argmin(misfits))
    return _BestLimbs(legs, arms, float(heights[best]), misfits[best])


def _misfit(
    skeleton: Skeleton,
    legs: MirroredLimbs,
    arms: MirroredLimbs | None,
    height: float,
    leg_misfit: LegMisfit,
) -> float:
    """Return how far limbs and trunk are from those of a person of this height."""
    limbs = [leg_misfit(tuple(leg), height) for leg in legs.limbs]
    if arms is None:
        return float(np.mean([*limbs, 1.0, 1.0])) + 1.0
    limbs += [divide_arm(skeleton, arms, side, height)[1] for side in (0, 1)]
    trunk = skeleton.rest_positions[arms.branch] - skeleton.rest_positions[legs.branch]
    length = max(float(np.linalg.norm(trunk)) / height, 1e-3)
    misfit = TRUNK_WEIGHT * abs(np.log(length / TRUNK_FRACTION)) + np.mean(limbs)
    if arms.branch in skeleton.ancestors(legs.branch):
        misfit += ROOT_AT_CHEST
    return float(misfit + (not _may_stand(skeleton, legs, trunk, height)))


def _may_stand(skeleton: Skeleton, legs: MirroredLimbs, trunk: Array, height: float) -> bool:
    """Whether the trunk continues the legs, as far as the rest pose shows it."""
    positions = skeleton.rest_positions
    along = positions[legs.branch] - positions[[leg[-1] for leg in legs.limbs]].mean(axis=0)
    lengths = np.linalg.norm(trunk), np.linalg.norm(along)
    if min(lengths) < MIN_SPREAD_FRACTION * height or is_folded(skeleton, legs, height):
        return True
    return is_human_angle(float(trunk @ along / np.prod(lengths)))


def _count_other_limbs(
    skeleton: Skeleton, match: _BestLimbs, pairs: Sequence[MirroredLimbs]
) -> int:
    """Return how many pairs of long limbs the trunk has in addition to legs and arms."""
    used = match.legs.joints(skeleton)
    trunk = {match.legs.branch}
    if match.arms:
        used |= match.arms.joints(skeleton)
        trunk |= {match.arms.branch, *skeleton.ancestors(match.arms.branch)}
    shortest = MAX_OTHER_LIMB_FRACTION * path_length(skeleton, match.legs.limbs[0])
    return sum(
        pair.branch in trunk
        and not used[[limb[0] for limb in pair.limbs]].any()
        and min(path_length(skeleton, limb) for limb in pair.limbs) > shortest
        for pair in pairs
    )


class _LimbedSkeleton:
    """A skeleton whose legs and arms are known."""

    def __init__(self, skeleton: Skeleton, match: _BestLimbs) -> None:
        self.skeleton = skeleton
        self.match = match
        self.positions: Array = skeleton.rest_positions
        self.sides = [side for side, _ in split_names(skeleton.names)]
        self.legs = [divide_leg(skeleton, leg, match.height)[0] for leg in match.legs.limbs]
        self.up, self.forward = rest_directions(skeleton, match.legs, self.legs, match.height)

    def roles(self) -> dict[str, int]:
        """Return joints by role; a joint of two roles keeps the first."""
        roles = {"hips": self._hips()}
        for name, side in self._assign_sides(self.match.legs).items():
            leg = self.legs[side]
            parts = (f"{name}UpperLeg", f"{name}LowerLeg", f"{name}Foot")
            roles |= dict(zip(parts, leg, strict=False))
            if leg and (toes := self._toes(leg[-1])) is not None:
                roles[f"{name}Toes"] = toes
        if self.match.arms:
            roles |= self._trunk(roles["hips"], self.match.arms)
            for name, side in self._assign_sides(self.match.arms).items():
                arm, _ = divide_arm(self.skeleton, self.match.arms, side, self.match.height)
                parts = (f"{name}UpperArm", f"{name}LowerArm", f"{name}Hand")
                roles |= dict(zip(parts, arm, strict=False))
                limb = self.match.arms.limbs[side]
                if above := limb[: limb.index(arm[0])] if arm else []:
                    away = [joint for joint in above if self.skeleton.offsets[joint].any()]
                    roles[f"{name}Shoulder"] = (away or above)[0]
        first_role: dict[int, str] = {}
        for role, joint in roles.items():
            first_role.setdefault(joint, role)
        return {role: joint for joint, role in first_role.items()}

    def _assumed_forward(self) -> Array:
        return np.array([0.0, -1.0, 0.0]) if self.forward is None else self.forward

    def _hips(self) -> int:
        """Return the lowest joint above legs and arms."""
        lineage = [self.match.legs.branch, *self.skeleton.ancestors(self.match.legs.branch)]
        if not self.match.arms:
            return lineage[0]
        branch = self.match.arms.branch
        above = {branch, *self.skeleton.ancestors(branch)}
        return next(joint for joint in lineage if joint in above)

    def _assign_sides(self, limbs: MirroredLimbs) -> dict[str, int]:
        """Return which of two limbs is "left" and which is "right"."""
        first, second = (
            sum(
                (self.sides[joint] == "left") - (self.sides[joint] == "right") for joint in limb
            )
            for limb in limbs.limbs
        )
        if first == second or first * second > 0:
            left = np.cross(self.up, self._assumed_forward())
            first, second = (self.positions[limb].mean(axis=0) @ left for limb in limbs.limbs)
        return {"left": 0, "right": 1} if first >= second else {"left": 1, "right": 0}

    def _toes(self, foot: int) -> int | None:
        """Return the foremost child of the foot, if it is in front of the ankle."""
        children = without_end_sites(self.skeleton, self.skeleton.children[foot])
        ahead = (self.positions - self.positions[foot]) @ self._assumed_forward()
        front = max(children, key=lambda joint: ahead[joint], default=foot)
        return front if ahead[front] > 0.0 else None

    def _trunk(self, hips: int, arms: MirroredLimbs) -> dict[str, int]:
        """Return spine, chest, neck and head by role."""
        chest = arms.branch
        spine = self._path(hips, chest)
        roles = dict(zip(("spine", "chest"), spine, strict=False))
        if len(spine) > 2:
            roles["chest"] = spine[(len(spine) - 1) // 2]
            roles["upperChest"] = spine[-1]
        limbs = arms.joints(self.skeleton) | self.match.legs.joints(self.skeleton)
        above = [j for j in self.skeleton.subtree(chest) if j != chest and not limbs[j]]
        if above:
            top = max(above, key=lambda joint: self.positions[joint] @ self.up)
            neck = without_end_sites(self.skeleton, self._path(chest, top))
            if len(neck) > 1 and FACE_OR_TIP.search(self.skeleton.names[neck[-1]]):
                neck = neck[:-1]
            branch = [j for j in neck if len(self.skeleton.children[j]) > 1]
            neck = neck[: neck.index(branch[0]) + 1] if branch else neck
            if neck:
                roles["head"] = neck[-1]
            if len(neck) > 1:
                roles["neck"] = neck[0]
        return roles

    def _path(self, start: int, stop: int) -> list[int]:
        """Return the joints from below `start` down to `stop`."""
        lineage = [stop, *self.skeleton.ancestors(stop)]
        return lineage[: lineage.index(start)][::-1] if start in lineage else []
