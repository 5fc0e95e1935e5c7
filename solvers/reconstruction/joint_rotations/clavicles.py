"""Shoulders and spine that move on the trunk, as those of people do."""

from collections.abc import Sequence

import numpy as np

from ...motion import Skeleton, roles_by_name

CLAVICLES = {"leftUpperArm": "ClavicleLeft", "rightUpperArm": "ClavicleRight"}
"""What is put between the trunk and an upper arm."""
LOW_SPINE = "SpineLow"
"""What is put between the hips and the spine, so that neither bends the other."""
LEGS = ("leftUpperLeg", "rightUpperLeg")


def add_clavicle_joints(skeleton: Skeleton) -> Skeleton:
    """Hang arms on clavicles, and the spine on a joint of its own, where there are none.

    Trackers hang shoulders, neck and spine right on the trunk, and then let them shift: an arm
    that is raised takes its shoulder along. A joint without length, in the same place, lets
    each of them point where it was seen. Rest pose and all other joints stay as they are.
    """
    roles = roles_by_name(skeleton.names)
    for role, name in CLAVICLES.items():
        if role in roles:
            skeleton = _insert_parent(skeleton, roles[role], name)
    above = _parent(skeleton, roles.get("spine", ""))
    if above == roles.get("hips") and all(
        _parent(skeleton, roles.get(leg, "")) for leg in LEGS
    ):
        skeleton = _insert_parent(skeleton, roles["spine"], LOW_SPINE)
    return skeleton


def _parent(skeleton: Skeleton, name: str) -> str | None:
    if name not in skeleton.names:
        return None
    above = skeleton.parents[skeleton.names.index(name)]
    return skeleton.names[above] if above >= 0 else None


def _insert_parent(skeleton: Skeleton, name: str, between: str) -> Skeleton:
    """Put a joint of no length between a joint and the one above, if that has others too."""
    joint = skeleton.names.index(name)
    above = skeleton.parents[joint]
    if above < 0 or len(skeleton.children[above]) < 2 or between in skeleton.names:
        return skeleton
    names: Sequence[str] = (*skeleton.names[:joint], between, *skeleton.names[joint:])
    moved = [parent + (parent >= joint) for parent in skeleton.parents]
    moved[joint] = joint
    parents = (*moved[:joint], above, *moved[joint:])
    offsets = np.insert(skeleton.offsets, joint, 0.0, axis=0)
    return Skeleton(tuple(names), parents, offsets)
