"""Insert clavicle and lower-spine joints."""

from collections.abc import Sequence

import numpy as np

from ...motion import Skeleton, roles_by_name

CLAVICLES = {"leftUpperArm": "ClavicleLeft", "rightUpperArm": "ClavicleRight"}
"""Joints inserted between the trunk and the upper arms."""
LOW_SPINE = "SpineLow"
"""Joint inserted between hips and spine, so that neither rotates the other."""
LEGS = ("leftUpperLeg", "rightUpperLeg")


def add_clavicle_joints(skeleton: Skeleton) -> Skeleton:
    """Insert clavicles above the arms, and a joint below the spine, where they are missing.

    Trackers attach shoulders, neck and spine directly to the trunk but let them shift, such as
    the shoulder of a raised arm. A joint of zero length at the same position lets each of them
    point to its observed position. The rest pose and all other joints stay unchanged.
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
