"""Find names of joints that the tree or the lengths contradict, and choose between both."""

from collections.abc import Mapping, Sequence
from itertools import pairwise, product

import numpy as np

from ...arrays import Array
from ..skeletons import Skeleton
from .limb_division import ARM_FRACTIONS, LEG_FRACTIONS, is_forearm, joint_between
from .names import name_matches, split_names
from .structure import HEIGHT_FACTORS, Structure
from .tables import ARM_ROLES, CENTRAL_ROLES, COLUMNS, LEG_ROLES, SIDES, TABLES

MIN_HUMANNESS = 0.6
"""Humanness of the proportions, as a fraction, from which the structure may contradict names.
Measured on the rigs of `tests/data/skeleton_families.txt`: their means are 0.74 to 0.8 without
a joint of trunk or foot, 0.2 to 0.54 without one of thigh, shin, arm or hand."""
MIN_MISFIT_MARGIN = 0.3
"""Misfit, the logarithm of a length, by which a limb as named must exceed the limb by structure
before the names are wrong. Measured: 0.02 is the most that was seen in real recordings, and
names shifted by one joint begin at 0.39."""
MAX_NAMED_MISFIT = 0.4
"""Misfit, the logarithm of a length, up to which each limb as named is human enough to be
believed without a search for others. Chosen by hand like `MIN_MISFIT_MARGIN`."""
MIN_LENGTH_FRACTION = 1e-4
"""Fraction of the height that stands for a bone without length; guards against a logarithm of
zero."""

HINGES = {"Leg": ("UpperLeg", "LowerLeg", "Foot"), "Arm": ("UpperArm", "LowerArm", "Hand")}
LENGTHS = {"Leg": LEG_FRACTIONS, "Arm": ARM_FRACTIONS}
PARTS = {"Leg": LEG_ROLES, "Arm": ARM_ROLES}
LIMBS = tuple((side, limb) for side in SIDES for limb in HINGES)


def matches_in_tree(skeleton: Skeleton) -> list[dict[str, str]]:
    """Return joint names by role, one match for each table of `TABLES`, as the tree has them.

    Of a joint and a namesake below it, such as a helper "__UpLeg" at the hips and "UpLeg" or
    wrappers "Root" and "root", the lower one moves. A hand begins at the wrist, and a foot at
    the ankle, where a rig has joints of both names. Hips that carry the legs only, next to the
    spine as in MikuMikuDance, leave their role to the joint that carries both.
    """
    names = ["".join((side, *words)) for side, words in split_names(skeleton.names)]
    found = []
    for row, match in zip(TABLES.values(), name_matches(skeleton.names), strict=True):
        match = _lowest_namesakes(skeleton, names, match)
        match = _beginning_at_wrists(skeleton, names, row, match)
        found.append(_with_hips_of_all_limbs(skeleton, match))
    return found


def _lowest_namesakes(
    skeleton: Skeleton, names: Sequence[str], match: Mapping[str, str]
) -> dict[str, str]:
    found = dict(match)
    for role in ("hips", *(side + part for side, limb in LIMBS for part in PARTS[limb])):
        joint = skeleton.index(match[role]) if role in match else None
        if joint is None or names.count(names[joint]) < 2:
            continue
        below = set(skeleton.subtree(joint))
        carried = [
            skeleton.index(match[each])
            for each in _carried_roles(role)
            if each in match and skeleton.index(match[each]) in below
        ]
        lineages = [{each, *skeleton.ancestors(each)} for each in carried]
        between = below.intersection(*lineages) if lineages else below
        lowest = max(each for each in between if names[each] == names[joint])
        found[role] = skeleton.names[lowest]
    return found


def _carried_roles(role: str) -> list[str]:
    """Return the roles that descend from that of the hips or of a part of a limb."""
    if role == "hips":
        return [f"{side}UpperLeg" for side in SIDES]
    side = next(each for each in SIDES if role.startswith(each))
    parts = next(each for each in PARTS.values() if role.removeprefix(side) in each)
    return [side + part for part in parts[parts.index(role.removeprefix(side)) + 1 :]]


def _beginning_at_wrists(
    skeleton: Skeleton, names: Sequence[str], row: Sequence[str], match: dict[str, str]
) -> dict[str, str]:
    taken = {skeleton.index(name) for name in match.values()}
    for side, parts in product(SIDES, HINGES.values()):
        limb = [match.get(side + part) for part in parts]
        if None in limb:
            continue
        top, upper, lower = (skeleton.index(str(name)) for name in limb)
        above = joint_between(skeleton, taken, upper, lower)
        end = parts[-1]
        if above is None or (end == "Hand" and is_forearm(skeleton, top, upper, lower, above)):
            continue
        if names[above].endswith(tuple(row[COLUMNS.index(end)].lower().split())):
            match = {**match, side + end: skeleton.names[above]}
    return match


def _with_hips_of_all_limbs(skeleton: Skeleton, match: dict[str, str]) -> dict[str, str]:
    limbs = [
        _lineage(skeleton, match[side + limb])
        for limb in ("UpperLeg", "UpperArm")
        for side in SIDES
        if side + limb in match
    ]
    if len(limbs) < 2 * len(SIDES) or "hips" not in match:
        return match
    legs, arms = (set.intersection(*pair) for pair in (limbs[:2], limbs[2:]))
    shared = [skeleton.index(name) for name in legs & arms]
    if match["hips"] not in legs - arms or not shared:
        return match
    lowest = skeleton.names[max(shared)]
    return match if lowest in match.values() else {**match, "hips": lowest}


def has_human_limbs(skeleton: Skeleton, joints: Mapping[str, str]) -> bool:
    """Whether all limbs of a map fit one height, and its hips carry legs and trunk.

    False if a joint has no role.
    """
    limbs = [[joints.get(side + part) for part in HINGES[limb]] for side, limb in LIMBS]
    if any(name is None for names in limbs for name in names):
        return False
    bones = [_bone_lengths(skeleton, [str(name) for name in names]) for names in limbs]
    if _trunk_is_contradicted(skeleton, joints, joints):
        return False
    legs = np.mean([
        each.sum() for each, (_, limb) in zip(bones, LIMBS, strict=True) if limb == "Leg"
    ])
    heights = max(float(legs), 1e-9) / sum(LEG_FRACTIONS) * HEIGHT_FACTORS
    misfits = [
        [_misfit(each, limb, height) for each, (_, limb) in zip(bones, LIMBS, strict=True)]
        for height in heights
    ]
    return min(map(max, misfits)) < MAX_NAMED_MISFIT


def contradicted_roles(
    skeleton: Skeleton, joints: Mapping[str, str], structure: Structure
) -> set[str]:
    """Return the roles that names and structure assign so differently that names are wrong.

    A limb is contradicted as a whole if its bones as named are far less human than those by
    structure; the trunk, if a part above the hips carries the legs, or the hips do not. Names
    stand where lengths do not decide.

    Parameters
    ----------
    skeleton : Skeleton
    joints : mapping of role to joint name
        The map by names.
    structure : Structure

    Returns
    -------
    set of str
        All roles of the contradicted limbs; empty if the body is hardly human.
    """
    if structure.humanness < MIN_HUMANNESS:
        return set()
    roles: set[str] = set()
    for side, limb in LIMBS:
        if _limb_is_contradicted(skeleton, joints, structure, side, limb):
            roles |= {side + part for part in PARTS[limb]}
    if _trunk_is_contradicted(skeleton, joints, structure.joints):
        roles |= set(CENTRAL_ROLES)
    return roles


def odd_limbs(skeleton: Skeleton, joints: Mapping[str, str], structure: Structure) -> set[str]:
    """Return the roles of the complete limbs whose bones are not those of the body's height."""
    return {
        side + part
        for side, limb in LIMBS
        if all(side + part in joints for part in HINGES[limb])
        and _misfit(
            _bone_lengths(skeleton, [joints[side + part] for part in HINGES[limb]]),
            limb,
            max(structure.height, MIN_LENGTH_FRACTION),
        )
        > MAX_NAMED_MISFIT
        for part in HINGES[limb]
    }


def without_contradictions(
    skeleton: Skeleton, joints: Mapping[str, str], structure: Structure
) -> dict[str, str]:
    """Return a map by names whose contradicted roles are those of the structure instead."""
    wrong = contradicted_roles(skeleton, joints, structure)
    decided = {r: joint for r, joint in structure.joints.items() if r in wrong}
    taken = set(decided.values())
    kept = {r: name for r, name in joints.items() if r not in wrong and name not in taken}
    return kept | decided


def _limb_is_contradicted(
    skeleton: Skeleton, joints: Mapping[str, str], structure: Structure, side: str, limb: str
) -> bool:
    roles = [side + part for part in HINGES[limb]]
    if not all(role in structure.joints for role in roles):
        return False
    by_structure = [structure.joints[role] for role in roles]
    by_name = [joints.get(role, structure.joints[role]) for role in roles]
    if _lacks_its_end(by_name, joints, roles[2]) and _is_chain(skeleton, by_name[:2]):
        return not _upper_misfit(skeleton, by_name, limb, structure.height) < _upper_misfit(
            skeleton, by_structure, limb, structure.height
        )
    # Without an ankle, the structure takes the toes for it; above, a lack is a conflict.
    lacking = {structure.joints[role] for role in roles[:2] if role not in joints}
    if not lacking.isdisjoint(joints.values()) or not _is_chain(skeleton, by_name):
        return True
    if by_name == by_structure:
        return False
    named, structural = (
        _misfit(_bone_lengths(skeleton, names), limb, structure.height)
        for names in (by_name, by_structure)
    )
    return named > structural + MIN_MISFIT_MARGIN


def _lacks_its_end(by_name: Sequence[str], joints: Mapping[str, str], end: str) -> bool:
    """Whether names have no hand or foot, and the structure takes the joint above for it."""
    return end not in joints and by_name[1] == by_name[2]


def _upper_misfit(skeleton: Skeleton, names: Sequence[str], limb: str, height: float) -> float:
    """Return the absolute log ratio of the upper bone of a limb to that of a person."""
    fraction = _bone_lengths(skeleton, names[:2])[0] / height
    return float(abs(np.log(max(fraction, MIN_LENGTH_FRACTION) / LENGTHS[limb][0])))


def _trunk_is_contradicted(
    skeleton: Skeleton, joints: Mapping[str, str], legs: Mapping[str, str]
) -> bool:
    """Whether the hips do not carry these legs, or a part above them does."""
    tops = [legs[role] for role in ("leftUpperLeg", "rightUpperLeg") if role in legs]
    if not tops:
        return False
    carries_legs = set.intersection(*(_lineage(skeleton, top) for top in tops))
    above = [joints[role] for role in CENTRAL_ROLES if role != "hips" and role in joints]
    return not carries_legs.isdisjoint(above) or (
        "hips" in joints and joints["hips"] not in carries_legs
    )


def _lineage(skeleton: Skeleton, name: str) -> set[str]:
    joint = skeleton.index(name)
    return {name, *(skeleton.names[above] for above in skeleton.ancestors(joint))}


def _is_chain(skeleton: Skeleton, names: Sequence[str]) -> bool:
    """Whether each of these joints is a descendant of the one before."""
    return all(
        upper != lower and upper in _lineage(skeleton, lower)
        for upper, lower in pairwise(names)
    )


def _bone_lengths(skeleton: Skeleton, names: Sequence[str]) -> Array:
    joints = [skeleton.index(name) for name in names]
    return np.asarray(np.linalg.norm(np.diff(skeleton.rest_positions[joints], axis=0), axis=1))


def _misfit(bones: Array, limb: str, height: float) -> float:
    """Return the sum of the absolute log ratios of two bones to those of a person."""
    fractions = np.maximum(bones / height, MIN_LENGTH_FRACTION)
    return float(np.abs(np.log(fractions / np.array(LENGTHS[limb]))).sum())
