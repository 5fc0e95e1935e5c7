"""Define the five partitions of the body that vary separately [ZH14, 4.1, figure 4.1]."""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...motion import Skeleton, find_humanoid_map


class Partition(Enum):
    """A part of the body, in the order of the rows of `partition_joints`."""

    TRUNK = "trunk and head"
    LEFT_ARM = "left arm"
    RIGHT_ARM = "right arm"
    LEFT_LEG = "left leg"
    RIGHT_LEG = "right leg"


LEG_ROWS = [list(Partition).index(leg) for leg in (Partition.LEFT_LEG, Partition.RIGHT_LEG)]
"""Rows of the left and the right leg."""
ROOT_ROW = len(Partition)
"""Row of weights of the root and the time warp, after those of the partitions."""

FIRST_ROLES = {
    Partition.LEFT_ARM: ("leftShoulder", "leftUpperArm"),
    Partition.RIGHT_ARM: ("rightShoulder", "rightUpperArm"),
    Partition.LEFT_LEG: ("leftUpperLeg",),
    Partition.RIGHT_LEG: ("rightUpperLeg",),
}
"""Humanoid roles at which each limb begins; the first that the skeleton has."""


def partition_joints(skeleton: Skeleton) -> NDArray[np.bool_]:
    """Return the joints of each partition, shape (5, n_joints); every joint is in exactly one.

    Joints outside the limbs, the root included, belong to the trunk.
    """
    joints = find_humanoid_map(skeleton).indices(skeleton)
    members = np.zeros((len(Partition), skeleton.n_joints), dtype=bool)
    for row, partition in enumerate(Partition):
        first = [joints[role] for role in FIRST_ROLES.get(partition, ()) if role in joints]
        if first:
            members[row, skeleton.subtree(first[0])] = True
    members[0] = ~members.any(axis=0)
    return members
