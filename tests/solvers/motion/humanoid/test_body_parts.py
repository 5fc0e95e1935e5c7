"""Body parts of joints follow from humanoid roles, and of others from their parents."""

import numpy as np

from solvers.motion import Skeleton, joint_parts
from solvers.samples import GaitSettings, walking_gait

ADDED = {"Jaw": "Head", "ArmTwist": "LeftForeArm", "Ring1": "LeftHand", "Tail": "Hips"}


def test_joints_without_a_role_belong_to_the_part_of_their_parent():
    walk = walking_gait(GaitSettings(duration=0.1)).skeleton
    skeleton = Skeleton(
        (*walk.names, *ADDED),
        (*walk.parents, *(walk.names.index(parent) for parent in ADDED.values())),
        np.concatenate([walk.offsets, np.full((len(ADDED), 3), 0.05)]),
    )

    part = dict(zip(skeleton.names, joint_parts(skeleton), strict=True))

    assert {name: part[name] for name in ADDED} == {
        "Jaw": "head", "ArmTwist": "arms", "Ring1": "hands", "Tail": "trunk",
    }  # fmt: skip
    assert (part["Hips"], part["Spine"], part["LeftShoulder"]) == ("trunk", "trunk", "arms")
    assert (part["LeftUpLeg"], part["LeftToeBase"], part["Neck"]) == ("legs", "legs", "head")
