"""Plan of the rig bones to key for each humanoid role."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from ...solvers.motion.humanoid import CENTRAL_ROLES
from ...solvers.settings import Choice

ROOT = "root"
"""Role name of the travel over the ground."""
LIMB = {
    "Shoulder": "upperChest", "UpperArm": "Shoulder", "LowerArm": "UpperArm",
    "Hand": "LowerArm", "UpperLeg": "hips", "LowerLeg": "UpperLeg", "Foot": "LowerLeg",
    "Toes": "Foot",
}  # fmt: skip
FINGER_PARTS = ("Metacarpal", "Proximal", "Intermediate", "Distal")


class Limbs(Choice):
    """Controls of arms and legs that are keyed, where a rig has both."""

    FK = "FK", "Key the FK controls and switch arms and legs to FK"
    IK = "IK", "Key the IK controls and switch arms and legs to IK"
    BOTH = (
        "both, FK plays",
        "Key the FK and IK controls; the rig plays FK and can switch to IK",
        "FK and IK",
    )


class Plan(NamedTuple):
    """A bone to be keyed."""

    bone: str
    role: str
    """Body part that defines its rotation, or ROOT."""
    anchor: str
    """Role of the joint that defines its position."""
    rotates: bool = True
    moves: bool = False
    limb: str = ""
    """Limb of a pole target, for example "leftLeg"."""


@dataclass(frozen=True)
class RigPlan:
    """Bones of a rig to key, and their roles.

    Attributes
    ----------
    plans : tuple of Plan
    joint_bones : mapping of role to the bone that shows where the joint is
    switches : mapping of bone and custom property to a value
        Keyed once, at the first frame.
    """

    plans: tuple[Plan, ...]
    joint_bones: Mapping[str, str]
    switches: Mapping[tuple[str, str], float]


def role_above(role: str, played: Sequence[str]) -> str:
    """Return the nearest role above that is played too, or nothing for the topmost one."""
    above = _role_above(role)
    while above and above not in played:
        above = _role_above(above)
    return above


def plain_plan(roles: Mapping[str, str], root_bone: str) -> RigPlan:
    """Return how a rig without controls is keyed: each bone by its own role.

    `root_bone` takes the travel; nothing where there is none.
    """
    plans = [Plan(bone, role, role, moves=role == "hips") for role, bone in roles.items()]
    return RigPlan((*_root_plan(root_bone), *plans), dict(roles), {})


def _root_plan(root_bone: str) -> list[Plan]:
    return [Plan(root_bone, ROOT, ROOT, moves=True)] if root_bone else []


def _role_above(role: str) -> str:
    if role in CENTRAL_ROLES:
        return CENTRAL_ROLES[CENTRAL_ROLES.index(role) - 1] if role != CENTRAL_ROLES[0] else ""
    side = "left" if role.startswith("left") else "right"
    part = role.removeprefix(side)
    if part in LIMB:
        return LIMB[part] if LIMB[part] in CENTRAL_ROLES else side + LIMB[part]
    end = next(each for each in FINGER_PARTS if part.endswith(each))
    index = FINGER_PARTS.index(end)
    return side + (part.removesuffix(end) + FINGER_PARTS[index - 1] if index else "Hand")
