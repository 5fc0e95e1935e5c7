"""Roles are found on common rigs, by names or by shape."""

import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from solvers.errors import InvalidMotionError
from solvers.motion import (
    HUMANOID_ROLES,
    HumanoidMap,
    Skeleton,
    find_humanoid_map,
    t_pose_alignment,
)
from solvers.motion.humanoid.roles import ESSENTIAL_ROLES
from solvers.motion.humanoid.structure import roles_by_structure
from solvers.motion.humanoid.tree_agreement import role_faults
from solvers.recordings import read_acclaim, read_bvh


def test_helper_joints_of_a_cmu_skeleton_have_no_role(recordings):
    skeleton = bvh_skeleton(recordings / "mocap/cmu_walk/07_01.bvh")

    found = find_humanoid_map(skeleton)

    assert found.score == 1.0
    assert found.joint("leftUpperLeg") == "LeftUpLeg"
    assert [found.joint(role) for role in ("spine", "chest", "upperChest", "neck")] == [
        "LowerBack", "Spine", "Spine1", "Neck",
    ]  # fmt: skip
    for helper in ("LHipJoint", "Neck1", "LThumb", "LeftFingerBase", "LeftHandIndex1"):
        assert found.role(helper) is None


def test_hand_of_acclaim_is_the_joint_that_bends_not_the_twist_joint_above_it(recordings):
    """Acclaim's wrist only turns, a third of the forearm above the hand."""
    skeleton = read_acclaim(recordings / "mocap/05_13.amc").skeleton

    found = find_humanoid_map(skeleton)

    assert found.score == 1.0
    assert [found.joint(role) for role in ("leftLowerArm", "leftHand", "rightHand")] == [
        "lradius", "lhand", "rhand",
    ]  # fmt: skip
    assert not role_faults(skeleton, found.joints)


def test_heel_is_not_classified_as_toe(body):
    """Rigify parents a heel to the foot, as low as the toes and behind them."""
    parents, offsets, names = list(body.parents), list(body.offsets), list(body.names)
    for side in ("Left", "Right"):
        names.append(f"{side}Heel")
        parents.append(body.index(f"{side}Foot"))
        offsets.append(np.array([0.0, 0.06, -0.08]))
    booted = Skeleton(tuple(names), tuple(parents), np.array(offsets))

    roles = roles_by_structure(booted).joints

    assert roles["leftFoot"] == "LeftFoot"
    assert roles["rightToes"] == "RightToeBase"


def test_shape_determines_roles_when_names_are_meaningless(body):
    by_name = find_humanoid_map(body)

    by_shape = find_humanoid_map(scrambled(body))

    assert by_name.score == 1.0
    assert by_name.has(*ESSENTIAL_ROLES, "leftToes", "rightShoulder", "upperChest")
    assert unscrambled(by_shape, body) == dict(by_name.joints)
    assert 0.4 < by_shape.score <= 0.8


@pytest.mark.parametrize(
    "name",
    ["mocap/cmu_walk/07_01.bvh", "mocap/cmu_walk/35_01.bvh", "formats/bvh/xsens_walk.bvh",
     "formats/bvh/optitrack_louise.bvh"],
)  # fmt: skip
def test_shape_agrees_with_names_on_real_skeletons(recordings, name):
    skeleton = bvh_skeleton(recordings / name)

    by_shape = find_humanoid_map(scrambled(skeleton))

    assert unscrambled(by_shape, skeleton) == dict(find_humanoid_map(skeleton).joints)


def test_roles_by_shape_ignore_scale_and_position(body):
    offsets = 100.0 * body.offsets
    offsets[0] += (700.0, -50.0, 300.0)
    big = Skeleton(body.names, body.parents, offsets)

    assert roles_by_structure(big).joints == roles_by_structure(body).joints


def test_skeleton_of_no_human_has_an_empty_map():
    stick = Skeleton(("a", "b"), (-1, 0), np.array([[0, 0, 1.0], [0, 0, 1.0]]))

    assert dict(find_humanoid_map(stick).joints) == {}
    assert find_humanoid_map(stick).score == 0.0


WORDS = st.sampled_from([
    "left",
    "Right",
    "l",
    "R",
    "arm",
    "Hand",
    "thumb",
    "ring",
    "spine",
    "01",
    "2",
    "_",
    ".",
    ":",
    "腕",
])


@given(st.data())
def test_random_trees_and_names_give_a_valid_map(data):
    n_joints = data.draw(st.integers(1, 14))
    names = data.draw(
        st.lists(st.lists(WORDS, min_size=1, max_size=4).map("".join), min_size=n_joints,
                 max_size=n_joints, unique=True)
    )  # fmt: skip
    parents = [-1, *(data.draw(st.integers(0, joint - 1)) for joint in range(1, n_joints))]
    offsets = data.draw(arrays(float, (n_joints, 3), elements=st.integers(-2, 2).map(float)))
    skeleton = Skeleton(tuple(names), tuple(parents), offsets)

    found = find_humanoid_map(skeleton)

    assert set(found.joints.values()) <= set(names)
    assert 0.0 <= found.score <= 1.0
    assert np.isfinite(t_pose_alignment(skeleton, found)).all()
    assert 0.0 <= roles_by_structure(skeleton).humanness <= 1.0


def test_single_arm_is_recognized_by_its_names():
    names = ("LeftArm", "LeftForeArm", "LeftHand")
    arm = Skeleton(names, (-1, 0, 1), np.array([[0, 0, 1.4], [0.3, 0, 0], [0.25, 0, 0]]))

    found = find_humanoid_map(arm)

    assert found.has("leftUpperArm", "leftLowerArm", "leftHand")
    assert found.score < 0.3


def test_wrong_parents_lower_the_confidence(body):
    parents = [max(parent, -1) if joint < 7 else 0 for joint, parent in enumerate(body.parents)]
    flat = Skeleton(body.names, tuple(parents), body.offsets)

    assert find_humanoid_map(flat).score < 0.7


def test_roles_can_be_corrected(body):
    found = find_humanoid_map(body)

    edited = found.with_joint("neck", "Spine2").with_joint("head", None)

    assert edited.role("Spine2") == "neck"
    assert edited.joint("upperChest") is None
    assert edited.joint("head") is None
    assert found.joint("head") == "Head"


def test_humanoid_map_can_be_pickled(body):
    found = find_humanoid_map(body)

    assert pickle.loads(pickle.dumps(found)) == found


def test_humanoid_map_is_immutable():
    with pytest.raises(TypeError):
        HumanoidMap({"hips": "Hips"}).joints["head"] = "Head"


def test_unknown_roles_and_joints_with_two_roles_are_refused():
    with pytest.raises(InvalidMotionError, match="These are not humanoid roles: tail"):
        HumanoidMap({"tail": "Tail"})
    with pytest.raises(InvalidMotionError, match="more than one has Spine"):
        HumanoidMap({"chest": "Spine", "spine": "Spine"})


def test_roles_are_unique_and_include_those_of_vrm():
    assert len(set(HUMANOID_ROLES)) == len(HUMANOID_ROLES) == 6 + 2 * (4 + 4 + 15)


def scrambled(skeleton: Skeleton) -> Skeleton:
    """Return the skeleton with meaningless names, except for end sites."""
    names = [f"j{i}" for i in range(skeleton.n_joints)]
    for joint, parent in enumerate(skeleton.parents):
        if skeleton.is_end_site(joint):
            names[joint] = f"{names[parent]}_end"
    return Skeleton(tuple(names), skeleton.parents, skeleton.offsets)


def unscrambled(found: HumanoidMap, skeleton: Skeleton) -> dict[str, str]:
    return {role: skeleton.names[int(name[1:])] for role, name in found.joints.items()}


def bvh_skeleton(path) -> Skeleton:
    return read_bvh(path).skeleton
