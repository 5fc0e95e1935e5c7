"""Humanoid maps: the role of each joint, shared by all rigs."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from ...errors import InvalidMotionError
from ..skeletons import Skeleton
from .names import roles_by_name
from .structure import roles_by_structure
from .tables import ARM_ROLES, CENTRAL_ROLES, FINGER_ROLES, LEG_ROLES

HUMANOID_ROLES = (
    *CENTRAL_ROLES,
    *(f"left{role}" for role in (*LEG_ROLES, *ARM_ROLES, *FINGER_ROLES)),
    *(f"right{role}" for role in (*LEG_ROLES, *ARM_ROLES, *FINGER_ROLES)),
)
"""VRM 1.0 and Unity names of the parts of a human body; parents precede children."""

ESSENTIAL_ROLES = (
    "hips", "spine", "head",
    *(f"{side}{role}" for side in ("left", "right")
      for role in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")),
)  # fmt: skip
"""What VRM requires of every humanoid."""

MIN_NAME_SCORE = 0.7
"""Score from which the roles by name are used, without those by structure."""


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
    separators, prefixes and spelling of sides. If that assigns too few roles, the structure of
    the rest pose is used, which must stand upright and face -Y. Helper joints, twist bones,
    props and faces have no role.

    Returns
    -------
    HumanoidMap
        Empty, with score 0, if the skeleton is not humanoid. The score by names is the fraction
        of VRM's essential roles found, lowered by wrong parents. The score by structure, up to
        0.8, measures how human the proportions are.
    """
    joints = roles_by_name(skeleton.names)
    by_name = HumanoidMap(joints, _coverage(joints) * _coherence(skeleton, joints))
    if by_name.score >= MIN_NAME_SCORE:
        return by_name
    joints, humanness = roles_by_structure(skeleton)
    by_structure = HumanoidMap(joints, 0.8 * humanness * _coverage(joints))
    return max(by_name, by_structure, key=lambda found: found.score)


def _coverage(joints: Mapping[str, str]) -> float:
    return sum(role in joints for role in ESSENTIAL_ROLES) / len(ESSENTIAL_ROLES)


def _coherence(skeleton: Skeleton, joints: Mapping[str, str]) -> float:
    """Return the fraction of limb joints that descend from the joint before, 0.5 to 1."""
    pairs = [
        (joints[f"{side}{upper}"], joints[f"{side}{lower}"])
        for side in ("left", "right")
        for upper, lower in (
            ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"),
            ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
        )
        if f"{side}{upper}" in joints and f"{side}{lower}" in joints
    ]  # fmt: skip
    connected = [
        skeleton.index(upper) in skeleton.ancestors(skeleton.index(lower))
        for upper, lower in pairs
    ]
    return 0.5 + 0.5 * sum(connected) / len(connected) if connected else 0.5
