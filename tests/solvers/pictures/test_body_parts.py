"""Figures show head and left limbs of a body, whatever its rest pose."""

import numpy as np

from solvers.motion import Skeleton, find_humanoid_map
from solvers.pictures.body_parts import head_bone, left_joints
from solvers.recordings import read_bvh

BOW = "corpus/bvh/bandai_namco/dataset-1_bow_active_001.bvh"


def test_a_rest_pose_along_one_axis_has_its_head_and_sides(recordings):
    skeleton = read_bvh(recordings / BOW).skeleton
    roles = find_humanoid_map(skeleton).indices(skeleton)

    is_left, head = left_joints(skeleton, roles), head_bone(skeleton, roles)

    left = {name for name, shown in zip(skeleton.names, is_left, strict=True) if shown}
    assert {"Hand_L", "Foot_L", "UpperArm_L"} <= left
    assert not any(name.endswith("_R") or name in {"Head", "Hips"} for name in left)
    assert head is not None and skeleton.names[head[1]] == "Head"


def test_an_unknown_body_is_shown_by_its_rest_pose():
    offsets = np.zeros((16, 3))
    offsets[1:, 2], offsets[8, 0] = 0.1, 0.5
    skeleton = Skeleton(
        tuple(f"j{joint}" for joint in range(16)), tuple(range(-1, 15)), offsets
    )

    assert head_bone(skeleton, {}) == (15, 14)
    assert left_joints(skeleton, {}).tolist() == [False] * 8 + [True] * 8
