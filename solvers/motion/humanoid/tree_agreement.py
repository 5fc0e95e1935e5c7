"""Whether the tree of a skeleton agrees with the roles that names suggest."""

from collections.abc import Mapping, Sequence
from itertools import pairwise, product

import numpy as np

from ..skeletons import Skeleton
from .limb_division import MIN_SPREAD_FRACTION, is_forearm, is_human_angle, joint_between
from .tables import SIDES

LIMBS = (("UpperLeg", "LowerLeg", "Foot"), ("UpperArm", "LowerArm", "Hand"))
ALL_PARTS = (("Toes", *LIMBS[0]), ("Shoulder", *LIMBS[1]))

MAX_BONE_RATIO = 3.0
"""Between upper and lower limb; people have 1.0 (legs) and 1.3 (arms), and 2.2 was seen in a
captured skeleton whose wrists were set too high. Chosen by hand on the rigs of
`tests/solvers/motion`."""
MAX_SIDE_RATIO = 1.6
"""Between both sides' bones. Chosen by hand on the rigs of `tests/solvers/motion`."""
MIN_TRUNK_FRACTION = 0.1
"""Of legs and trunk, below which it is folded. By hand on rigs of `tests/solvers/motion`."""

SKIPPED_JOINT = 0.5
"""Factor of the score of a map that leaves a joint of a limb out. Chosen by hand on the rigs of
`tests/solvers/motion`."""
NO_SPINE = 0.7
"""Factor of the score of a map without a spine. Chosen by hand on the rigs of
`tests/solvers/motion`."""
ODD_LENGTHS = 0.6
"""Factor of the score of a map whose bones differ too much in length. Chosen by hand on the
rigs of `tests/solvers/motion`."""
NOT_STANDING = 0.4
"""Factor of the score of a map whose legs do not stand below the trunk. Chosen by hand on the
rigs of `tests/solvers/motion`."""
ARM_TO_LEG, TRUNK_TO_LEG = (0.52, 0.9), (0.2, 0.8)
"""Lengths relative to thigh and shank: of the arm bones (0.68 in people), and from hips to neck
(0.6); from Winter 2009, figure 4.1, with a margin. The trunks of animals are longer. The neck
of CMU's rigs starts in the chest: 0.26 to 0.31."""


def tree_agreement(skeleton: Skeleton, joints: Mapping[str, str]) -> float:
    """Return how well a map fits the tree and the lengths of the bones, 0 to 1.

    Parameters
    ----------
    skeleton : Skeleton
    joints : mapping of role to joint name

    Returns
    -------
    float
        1 where limb joints descend from each other, no joint of a limb or of the spine is
        left over between two that have a role, lengths are human, and the rest pose stands. A
        body of clearly human lengths may rest in any pose, such as the first of a somersault.
    """
    indices = {name: index for index, name in enumerate(skeleton.names)}
    roles = {role: indices[name] for role, name in joints.items()}
    agreement = _descent(skeleton, roles)
    if _left_out(skeleton, roles):
        agreement *= SKIPPED_JOINT
    if _skips_spine(skeleton, roles):
        agreement *= NO_SPINE
    if _has_odd_lengths(skeleton, roles):
        agreement *= ODD_LENGTHS
    if not (stands_upright(skeleton, roles) or _has_human_lengths(skeleton, roles)):
        agreement *= NOT_STANDING
    return agreement


def stands_upright(skeleton: Skeleton, roles: Mapping[str, int]) -> bool:
    """Whether the trunk continues the legs in the rest pose, as far as it shows it."""
    chest = [roles[r] for r in ("neck", "upperChest", "chest", "head") if r in roles][:1]
    feet, tops, shoulders = (
        [roles[side + part] for side in SIDES if side + part in roles]
        for part in ("Foot", "UpperLeg", "UpperArm")
    )
    upper = shoulders or chest
    if not upper or len(feet) < 2:
        return True
    above_both = set(skeleton.ancestors(feet[0])) & set(skeleton.ancestors(feet[1]))
    pelvis = [roles["hips"]] if "hips" in roles else tops or [max(above_both, default=0)]
    positions = skeleton.rest_positions
    hips = positions[pelvis].mean(axis=0)
    legs, trunk = hips - positions[feet].mean(axis=0), positions[upper].mean(axis=0) - hips
    leg, back = np.linalg.norm(legs), np.linalg.norm(trunk)
    height = float(leg + back)
    half_distance = np.linalg.norm(positions[feet[0]] - positions[feet[1]]) / 2
    if half_distance < MIN_SPREAD_FRACTION * height or back < MIN_TRUNK_FRACTION * height:
        return True  # folded: all bones have one direction
    return is_human_angle(float(legs @ trunk / max(leg * back, 1e-12)))


def _has_human_lengths(skeleton: Skeleton, roles: Mapping[str, int]) -> bool:
    """Whether arms and trunk are as long, relative to the legs, as those of people."""
    if not {"hips", "neck"} <= roles.keys() or any(
        side + part not in roles for side in SIDES for limb in LIMBS for part in limb
    ):
        return False
    legs, arms = (
        sum(
            _path_length(skeleton, roles[side + limb[0]], roles[side + limb[-1]])
            for side in SIDES
        )
        / 2
        for limb in LIMBS
    )
    trunk = _path_length(skeleton, roles["hips"], roles["neck"])
    return bool(
        ARM_TO_LEG[0] < arms / max(legs, 1e-9) < ARM_TO_LEG[1]
        and TRUNK_TO_LEG[0] < trunk / max(legs, 1e-9) < TRUNK_TO_LEG[1]
    )


def _path_length(skeleton: Skeleton, above: int, below: int) -> float:
    """Return the length of the bones from one joint down to another; 0 if it is not below."""
    chain = [below, *skeleton.ancestors(below)]
    if above not in chain:
        return 0.0
    bones = chain[: chain.index(above)]
    return float(np.linalg.norm(skeleton.offsets[bones], axis=1).sum())


def _descent(skeleton: Skeleton, roles: Mapping[str, int]) -> float:
    """Return the fraction of limb joints that descend from the joint before, 0.5 to 1."""
    pairs = _links(roles)
    connected = [upper in skeleton.ancestors(lower) for upper, lower in pairs]
    return 0.5 + 0.5 * sum(connected) / len(connected) if connected else 0.5


def _links(roles: Mapping[str, int]) -> list[tuple[int, int]]:
    """Return the joints of each link of a limb, from one with a role to the next."""
    limbs = [
        [roles[side + part] for part in limb if side + part in roles]
        for side in SIDES
        for limb in LIMBS
    ]
    return [link for limb in limbs for link in pairwise(limb)]


def _left_out(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[tuple[int, int], int]:
    """Return by link the joint that lies between its ends and should have one of their roles.

    One within a forearm is none if the arm is more human without it, as Acclaim's wrist.
    """
    arms = {
        (roles[side + "LowerArm"], roles[side + "Hand"]): roles[side + "UpperArm"]
        for side in SIDES
        if {side + part for part in LIMBS[1]} <= roles.keys()
    }
    found = {
        link: joint_between(skeleton, set(roles.values()), *link) for link in _links(roles)
    }
    return {
        link: joint
        for link, joint in found.items()
        if joint is not None
        and not (link in arms and is_forearm(skeleton, arms[link], *link, joint))
    }


def role_faults(skeleton: Skeleton, joints: Mapping[str, str]) -> dict[str, str]:
    """Return the evidence of tree and lengths against the role of a limb's joint.

    Parameters
    ----------
    skeleton : Skeleton
    joints : mapping of role to joint name

    Returns
    -------
    dict of role to clause, such as "it is not a descendant of LeftUpLeg"; empty without faults
    """
    indices = {name: index for index, name in enumerate(skeleton.names)}
    roles = {role: indices[name] for role, name in joints.items()}
    role_of = {joint: role for role, joint in roles.items()}
    faults: dict[str, str] = {}
    left_out = _left_out(skeleton, roles)
    for upper, lower in _links(roles):
        name = skeleton.names[upper]
        if upper not in skeleton.ancestors(lower):
            faults[role_of[lower]] = f"it is not a descendant of {name}"
        elif (upper, lower) in left_out:
            between = skeleton.names[left_out[upper, lower]]
            for joint in (upper, lower):
                faults[role_of[joint]] = f"{between} lies between two parts"
    faults |= _missing_middles(roles) | _trunk_faults(skeleton, roles)
    for limb in LIMBS:
        if _has_odd_lengths(skeleton, roles, (limb,)):
            odd = {f"{side}{part}" for side in SIDES for part in limb} & roles.keys()
            faults |= dict.fromkeys(odd - faults.keys(), "the limb proportions are not human")
    return faults


def _missing_middles(roles: Mapping[str, int]) -> dict[str, str]:
    """Return a clause for both ends of each limb whose middle has no joint."""
    faults: dict[str, str] = {}
    for side, (upper, middle, end) in product(SIDES, LIMBS):
        ends = {f"{side}{upper}", f"{side}{end}"}
        if ends <= roles.keys() and f"{side}{middle}" not in roles:
            faults |= dict.fromkeys(ends, f"no bone between plays {side}{middle}")
    return faults


def missing_ends(joints: Mapping[str, str]) -> dict[str, str]:
    """Return a clause for the parts of each limb whose first or last part has no joint.

    That is a fault only if nothing else supports them: some rigs have no hands or feet.
    """
    faults: dict[str, str] = {}
    for side, limb in product(SIDES, ALL_PARTS):
        upper, end = limb[1], limb[-1]
        present = {side + part for part in limb} & joints.keys()
        if present and side + upper not in present:
            faults |= dict.fromkeys(present, f"no bone above plays {side}{upper}")
        elif present and side + end not in present:
            faults |= dict.fromkeys(present, f"no bone below plays {side}{end}")
    return faults


def _trunk_faults(skeleton: Skeleton, roles: Mapping[str, int]) -> dict[str, str]:
    """Return a clause for each part of the trunk that carries limbs it cannot, or does not."""
    faults: dict[str, str] = {}
    legs, arms = (
        [
            {roles[side + part], *skeleton.ancestors(roles[side + part])}
            for side in SIDES
            if (part := next((p for p in limb if side + p in roles), None))
        ]
        for limb in LIMBS
    )
    carries_legs = set.intersection(*legs) if legs else set()
    carries_arms = set.intersection(*arms) if arms else set()
    if "hips" in roles and carries_legs and roles["hips"] not in carries_legs:
        faults["hips"] = "it does not carry the legs"
    for role in ("spine", "chest", "upperChest", "neck", "head"):
        if roles.get(role) in carries_legs:
            faults[role] = "it carries the legs"
        elif roles.get(role) in carries_arms and (
            role == "head" or (role == "neck" and _goes_on(skeleton, roles.get("head")))
        ):
            faults[role] = "it carries the arms"  # where the neck may, the head ends
    return faults


def _goes_on(skeleton: Skeleton, joint: int | None) -> bool:
    return joint is not None and any(
        not skeleton.is_end_site(child) for child in skeleton.children[joint]
    )


def _skips_spine(skeleton: Skeleton, roles: Mapping[str, int]) -> bool:
    """Whether there are joints between hips and arms, none of which has a role."""
    arm = next((roles[r] for r in ("leftUpperArm", "rightUpperArm") if r in roles), None)
    if arm is None or "hips" not in roles or {"spine", "chest", "upperChest"} & set(roles):
        return False
    above = skeleton.ancestors(arm)
    if roles["hips"] not in above:
        return False
    free = [j for j in above[: above.index(roles["hips"])] if j not in set(roles.values())]
    return len(free) > 1  # one may be the shoulder


def _has_odd_lengths(
    skeleton: Skeleton, roles: Mapping[str, int], limbs: Sequence[tuple[str, ...]] = LIMBS
) -> bool:
    """Whether a limb's upper and lower bones, or both sides, differ as in no person."""
    for limb in limbs:
        lengths = {}
        for side in SIDES:
            joints = [roles[f"{side}{part}"] for part in limb if f"{side}{part}" in roles]
            if len(joints) == len(limb):
                bones = np.diff(skeleton.rest_positions[joints], axis=0)
                lengths[side] = np.maximum(np.linalg.norm(bones, axis=1), 1e-9)
        if any(_ratio(*bones) > MAX_BONE_RATIO for bones in lengths.values()):
            return True
        if len(lengths) == 2 and max(map(_ratio, *lengths.values())) > MAX_SIDE_RATIO:
            return True
    return False


def _ratio(one: float, other: float) -> float:
    return max(one, other) / min(one, other)
