"""The five partitions of the body that vary each in its own way [ZH14, 4.1, figure 4.1]."""

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton, find_humanoid_map


class Partition(Enum):
    """A part of the body; the order is that of the rows of `partition_joints`."""

    TRUNK = "trunk and head"
    LEFT_ARM = "left arm"
    RIGHT_ARM = "right arm"
    LEFT_LEG = "left leg"
    RIGHT_LEG = "right leg"


FEET = [list(Partition).index(leg) for leg in (Partition.LEFT_LEG, Partition.RIGHT_LEG)]
"""Rows of the partitions that stand on the ground, left and right."""

FIRST_ROLES = {
    Partition.LEFT_ARM: ("leftShoulder", "leftUpperArm"),
    Partition.RIGHT_ARM: ("rightShoulder", "rightUpperArm"),
    Partition.LEFT_LEG: ("leftUpperLeg",),
    Partition.RIGHT_LEG: ("rightUpperLeg",),
}
"""Roles at which each limb begins, the first that the skeleton has."""


def partition_joints(skeleton: Skeleton) -> NDArray[np.bool_]:
    """Return which joints each partition has, shape (5, n_joints); every joint is in one.

    What hangs on no limb belongs to the trunk, the root too.
    """
    places = find_humanoid_map(skeleton).indices(skeleton)
    members = np.zeros((len(Partition), skeleton.n_joints), dtype=bool)
    for row, partition in enumerate(Partition):
        first = [places[role] for role in FIRST_ROLES.get(partition, ()) if role in places]
        if first:
            members[row, skeleton.subtree(first[0])] = True
    members[0] = ~members.any(axis=0)
    return members
