"""Humanoid maps: the role of each joint, shared by all rigs."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from types import MappingProxyType
from typing import Any

import numpy as np

from ...errors import InvalidMotionError
from ..skeletons import Skeleton
from .name_conflicts import has_human_limbs, matches_in_tree, without_contradictions
from .names import with_fingers
from .structure import Structure, roles_by_structure
from .tables import ARM_ROLES, CENTRAL_ROLES, FINGER_ROLES, LEG_ROLES, SIDES
from .tree_agreement import tree_agreement

HUMANOID_ROLES = (
    *CENTRAL_ROLES,
    *(f"left{role}" for role in (*LEG_ROLES, *ARM_ROLES, *FINGER_ROLES)),
    *(f"right{role}" for role in (*LEG_ROLES, *ARM_ROLES, *FINGER_ROLES)),
)
"""VRM 1.0 and Unity names of the parts of a human body; parents precede children."""

ESSENTIAL_ROLES = (
    "hips", "spine", "head",
    *(f"{side}{role}" for side in SIDES
      for role in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")),
)  # fmt: skip
"""Roles that VRM requires of every humanoid."""

BODY_ROLES = (
    *CENTRAL_ROLES,
    *(f"{side}{role}" for side in SIDES for role in (*LEG_ROLES, *ARM_ROLES)),
)
"""All roles but the fingers."""

MIN_NAME_SCORE = 0.7
"""Score, as a fraction, from which the roles by name are used; structure only fills what they
leave empty. Chosen by hand on the rigs of `tests/solvers/motion`."""
MIN_MATCH = 0.5
"""Roles that a table must match, relative to the table that matches most. Chosen by hand on the
rigs of `tests/solvers/motion`."""
MAX_STRUCTURE_SCORE = 0.8
"""Maximum score, as a fraction, of roles that are found by structure. Chosen by hand on the
rigs of `tests/solvers/motion`."""
MIN_AGREEMENT = 0.9
"""Fraction, of the roles that names and structure both assign, so that structure may fill
others. Chosen by hand on the rigs of `tests/solvers/motion`."""

NO_HAND = re.compile(
    r"prop|weapon|sword|gun|finger|thumb|index|mid|ring|pinky|little", re.IGNORECASE
)
"""Names of what lies beyond a hand."""
REMEMBERED_MAPS = 8
"""Skeletons whose maps are kept."""


@dataclass(frozen=True)
class HumanoidMap:
    """Assignment of joints to humanoid roles.

    Attributes
    ----------
    joints : mapping of role to joint name
        Roles of `HUMANOID_ROLES`; no joint has two. Immutable; `with_joint` returns another
        map.
    score : float
        Confidence, 0 to 1. An edited map keeps the score of the original.
    """

    joints: Mapping[str, str] = field(default_factory=dict)
    score: float = 1.0

    def __post_init__(self) -> None:
        joints = {role: self.joints[role] for role in HUMANOID_ROLES if role in self.joints}
        unknown = [role for role in self.joints if role not in joints]
        if unknown:
            raise InvalidMotionError(f"These are not humanoid roles: {', '.join(unknown)}.")
        names = list(joints.values())
        duplicates = sorted({name for name in names if names.count(name) > 1})
        if duplicates:
            raise InvalidMotionError(
                f"A joint can play one role only; more than one has {', '.join(duplicates)}."
            )
        object.__setattr__(self, "joints", MappingProxyType(joints))

    def __reduce__(self) -> tuple[Any, ...]:
        """Travel to another process as a plain dict: a mapping proxy cannot be pickled."""
        return HumanoidMap, (dict(self.joints), self.score)

    def joint(self, role: str) -> str | None:
        """Return the name of the joint that plays `role`, or None."""
        return self.joints.get(role)

    def role(self, joint_name: str) -> str | None:
        """Return the role of this joint, or None."""
        return next((role for role, name in self.joints.items() if name == joint_name), None)

    def has(self, *roles: str) -> bool:
        """Return whether all these roles have a joint."""
        return all(role in self.joints for role in roles)

    def with_joint(self, role: str, joint: str | None) -> "HumanoidMap":
        """Return the map with `role` assigned to `joint` only; None leaves the role empty."""
        others = {r: name for r, name in self.joints.items() if r != role and name != joint}
        return replace(self, joints=others if joint is None else {**others, role: joint})

    def indices(self, skeleton: Skeleton) -> dict[str, int]:
        """Return the index of each role's joint; roles whose joint is missing are left out."""
        index_of = {name: index for index, name in enumerate(skeleton.names)}
        return {role: index_of[name] for role, name in self.joints.items() if name in index_of}


def find_humanoid_map(skeleton: Skeleton) -> HumanoidMap:
    """Assign humanoid roles to the joints of a skeleton.

    Names are compared with the tables of the known rig families, without regard to case,
    separators, prefixes, numbers of exporters and spelling of sides. A table is believed only
    as far as the tree agrees: joints descend from each other, none is left over between two,
    and lengths are human. If no table is, the tree and the lengths decide, whatever the axes
    of the rest pose; they also fill what an agreeing table leaves empty. Helper joints, twist
    bones, props and faces have no role.

    Returns
    -------
    HumanoidMap
        Empty, with score 0, if the skeleton is not humanoid. The score by names is the fraction
        of VRM's essential roles found, lowered where the tree disagrees. The score by
        structure, up to 0.8, measures how human the proportions are.
    """
    return _find_map(skeleton.names, skeleton.parents, skeleton.offsets.tobytes())


@lru_cache(maxsize=REMEMBERED_MAPS)
def _find_map(names: tuple[str, ...], parents: tuple[int, ...], offsets: bytes) -> HumanoidMap:
    """Return the map; many steps of one press ask for that of the same skeleton."""
    skeleton = Skeleton(names, parents, np.frombuffer(offsets).reshape(-1, 3))
    by_name = _best_names(skeleton)
    is_complete = by_name.has(*BODY_ROLES) and by_name.score == 1.0
    if is_complete and has_human_limbs(skeleton, by_name.joints):
        return by_name
    structure = roles_by_structure(skeleton)
    joints = _without_false_hands(structure.joints)
    by_structure = HumanoidMap(
        joints, MAX_STRUCTURE_SCORE * structure.humanness * _coverage(joints)
    )
    by_name = _correct_by_structure(skeleton, by_name, structure)
    if by_name.score >= MIN_NAME_SCORE:
        return _fill_from(skeleton, by_name, by_structure)
    return max(by_name, by_structure, key=lambda found: found.score)


def _best_names(skeleton: Skeleton) -> HumanoidMap:
    """Return the match of one table of names that covers most and that the tree confirms."""
    matches = matches_in_tree(skeleton)
    most = max(map(len, matches))
    scored = [
        _score_names(skeleton, joints) for joints in matches if len(joints) > MIN_MATCH * most
    ]
    best = max(scored, key=lambda found: (found.score, len(found.joints)), default=None)
    if best is None:
        return HumanoidMap({}, 0.0)
    return replace(
        best, joints=_fingers_below_hands(skeleton, with_fingers(skeleton.names, best.joints))
    )


def _fingers_below_hands(skeleton: Skeleton, joints: Mapping[str, str]) -> dict[str, str]:
    """Return the map without fingers that do not descend from the hand of their side."""
    below = {
        side: {skeleton.names[joint] for joint in skeleton.subtree(skeleton.index(hand))}
        for side in SIDES
        if (hand := joints.get(f"{side}Hand"))
    }
    return {
        role: joint
        for role, joint in joints.items()
        if role in BODY_ROLES or joint in below.get(_side(role), ())
    }


def _side(role: str) -> str:
    return "left" if role.startswith("left") else "right"


def _without_false_hands(joints: Mapping[str, str]) -> dict[str, str]:
    """Return the map without hands whose name is that of a prop or a finger."""
    return {
        role: joint
        for role, joint in joints.items()
        if not role.endswith("Hand") or not NO_HAND.search(joint)
    }


def _correct_by_structure(
    skeleton: Skeleton, by_name: HumanoidMap, structure: Structure
) -> HumanoidMap:
    """Return the map by names with the structure's roles where lengths contradict names.

    Names stand where the tree agrees better with them: the legs of a cartoon may be short.
    """
    joints = _without_false_hands(without_contradictions(skeleton, by_name.joints, structure))
    if joints == dict(by_name.joints):
        return by_name
    joints = _fingers_below_hands(skeleton, joints)
    corrected = _score_names(skeleton, joints)
    if corrected.score < by_name.score:
        return by_name
    return replace(corrected, score=min(corrected.score, MAX_STRUCTURE_SCORE))


def _score_names(skeleton: Skeleton, joints: Mapping[str, str]) -> HumanoidMap:
    return HumanoidMap(joints, _coverage(joints) * tree_agreement(skeleton, joints))


def _fill_from(
    skeleton: Skeleton, by_name: HumanoidMap, by_structure: HumanoidMap
) -> HumanoidMap:
    """Return the map by names, its empty roles filled by structure where both agree."""
    both = [role for role in by_structure.joints if role in by_name.joints]
    agreed = sum(by_name.joints[role] == by_structure.joints[role] for role in both)
    if agreed < MIN_AGREEMENT * max(len(both), 1):
        return _with_hips_of(skeleton, by_name, by_structure)
    taken = set(by_name.joints.values())
    added = {
        role: joint
        for role, joint in by_structure.joints.items()
        if role not in by_name.joints and joint not in taken
    }
    joints = _lower_spine(skeleton, {**by_name.joints, **added})
    return _score_names(skeleton, joints) if joints != dict(by_name.joints) else by_name


def _with_hips_of(
    skeleton: Skeleton, by_name: HumanoidMap, by_structure: HumanoidMap
) -> HumanoidMap:
    """Return the map by names with the hips by structure, if only they carry its legs."""
    hips = by_structure.joint("hips")
    legs = [by_name.joint(role) for role in ("leftUpperLeg", "rightUpperLeg")]
    if by_name.has("hips") or hips is None or hips in by_name.joints.values():
        return by_name
    above = [set(skeleton.ancestors(skeleton.index(leg))) for leg in legs if leg is not None]
    if len(above) < 2 or max(above[0] & above[1], default=-1) != skeleton.index(hips):
        return by_name
    return _score_names(skeleton, _lower_spine(skeleton, {**by_name.joints, "hips": hips}))


def _lower_spine(skeleton: Skeleton, joints: dict[str, str]) -> dict[str, str]:
    """Return the map with the first joint above the hips as spine, if it has no role.

    A table may call the only joint it knows the spine, where others lie below it, or know only
    a chest.
    """
    if "spine" not in joints and "chest" in joints:
        lower = {"spine": joints["chest"], "chest": joints.get("upperChest", "")}
        others = {r: j for r, j in joints.items() if r not in ("chest", "upperChest")}
        return others | {role: joint for role, joint in lower.items() if joint}
    if not {"hips", "spine"} <= joints.keys() or "chest" in joints:
        return joints
    above = skeleton.ancestors(skeleton.index(joints["spine"]))
    hips = skeleton.index(joints["hips"])
    between = above[: above.index(hips)] if hips in above else []
    free = [j for j in between if skeleton.names[j] not in joints.values()]
    if not free:
        return joints
    return joints | {"spine": skeleton.names[free[-1]], "chest": joints["spine"]}


def _coverage(joints: Mapping[str, str]) -> float:
    return sum(role in joints for role in ESSENTIAL_ROLES) / len(ESSENTIAL_ROLES)
