"""Which joint of a skeleton plays which humanoid role: the hinge between rigs."""

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

SURE_ENOUGH = 0.7
"""From this score on, names are believed and the shape of the body is not asked."""


@dataclass(frozen=True)
class HumanoidMap:
    """Which joint plays which humanoid role.

    Attributes
    ----------
    joints : mapping of role to joint name
        Roles of `HUMANOID_ROLES`; no joint plays two. It cannot be changed; `with_joint` makes
        another map.
    score : float
        0 to 1: how sure the finding is. An edited map keeps the score of its origin.
    """

    joints: Mapping[str, str] = field(default_factory=dict)
    score: float = 1.0

    def __post_init__(self) -> None:
        joints = {role: self.joints[role] for role in HUMANOID_ROLES if role in self.joints}
        unknown = [role for role in self.joints if role not in joints]
        if unknown:
            raise InvalidMotionError(f"These are no humanoid roles: {', '.join(unknown)}.")
        names = list(joints.values())
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise InvalidMotionError(
                f"A joint can play one role only; more than one has {', '.join(twice)}."
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
        """Tell whether all these roles are played."""
        return all(role in self.joints for role in roles)

    def with_joint(self, role: str, joint: str | None) -> "HumanoidMap":
        """Return the map in which `joint` plays `role` and no other; None leaves it empty."""
        others = {r: name for r, name in self.joints.items() if r != role and name != joint}
        return replace(self, joints=others if joint is None else {**others, role: joint})

    def indices(self, skeleton: Skeleton) -> dict[str, int]:
        """Return each role's joint as its index; roles whose joint is missing are left out."""
        place = {name: index for index, name in enumerate(skeleton.names)}
        return {role: place[name] for role, name in self.joints.items() if name in place}


def find_humanoid_map(skeleton: Skeleton) -> HumanoidMap:
    """Find out which joint plays which humanoid role.

    Names are compared with the tables of the known rig families, without regard to case,
    separators, prefixes and spelling of sides. Where that finds less than most of a body, the
    rest pose is asked, which must stand upright and face -Y. Helper joints, twist bones, props
    and faces have no role.

    Returns
    -------
    HumanoidMap
        Empty, with score 0, where nothing looks human. The score of names is the share of
        essential roles (VRM's) found, less where joints hang on the wrong parents; that of
        structure is how human the proportions are, and at most 0.8.
    """
    joints = roles_by_name(skeleton.names)
    by_name = HumanoidMap(joints, _coverage(joints) * _coherence(skeleton, joints))
    if by_name.score >= SURE_ENOUGH:
        return by_name
    joints, humanness = roles_by_structure(skeleton)
    by_structure = HumanoidMap(joints, 0.8 * humanness * _coverage(joints))
    return max(by_name, by_structure, key=lambda found: found.score)


def _coverage(joints: Mapping[str, str]) -> float:
    return sum(role in joints for role in ESSENTIAL_ROLES) / len(ESSENTIAL_ROLES)


def _coherence(skeleton: Skeleton, joints: Mapping[str, str]) -> float:
    """Return the share of limb joints that hang below the joint of the role before."""
    pairs = [
        (joints[f"{side}{upper}"], joints[f"{side}{lower}"])
        for side in ("left", "right")
        for upper, lower in (
            ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"),
            ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
        )
        if f"{side}{upper}" in joints and f"{side}{lower}" in joints
    ]  # fmt: skip
    hanging = [
        skeleton.index(upper) in skeleton.ancestors(skeleton.index(lower))
        for upper, lower in pairs
    ]
    return 0.5 + 0.5 * sum(hanging) / len(hanging) if hanging else 0.5
