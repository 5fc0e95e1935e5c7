"""Assign the joints of a skeleton to the parts of the body that animators name."""

from ..skeletons import Skeleton
from .roles import find_humanoid_map
from .tables import ARM_ROLES, FINGER_ROLES, LEG_ROLES, SIDES

TRUNK, ARMS, LEGS, HEAD, HANDS = BODY_PARTS = ("trunk", "arms", "legs", "head", "hands")
PART_OF_ROLE = {
    **dict.fromkeys(("neck", "head"), HEAD),
    **{f"{side}{role}": LEGS for side in SIDES for role in LEG_ROLES},
    **{f"{side}{role}": ARMS for side in SIDES for role in ARM_ROLES},
    **{f"{side}{role}": HANDS for side in SIDES for role in ("Hand", *FINGER_ROLES)},
}
"""Part of the body of each humanoid role; the other roles are of the trunk."""


def joint_parts(skeleton: Skeleton) -> tuple[str, ...]:
    """Return the part of the body, of `BODY_PARTS`, of each joint.

    It follows from the joint's humanoid role. A joint without a role has the part of its
    parent: a twist bone is of its arm, and a jaw of the head. One above the hips is of the
    trunk.
    """
    joints = find_humanoid_map(skeleton).joints
    part_of = {name: PART_OF_ROLE.get(role, TRUNK) for role, name in joints.items()}
    parts: list[str] = []
    for name, parent in zip(skeleton.names, skeleton.parents, strict=True):
        inherited = parts[parent] if parent >= 0 else TRUNK
        parts.append(part_of.get(name, inherited))
    return tuple(parts)
