"""Roles must be found on the rigs that animators have, by name or else by shape."""

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
from solvers.motion.humanoid import ESSENTIAL_ROLES
from solvers.motion.humanoid_names import roles_by_name
from solvers.motion.humanoid_structure import roles_by_structure
from solvers.recordings import read_bvh

LIMBS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
FAMILIES = {
    "Mixamo": "mixamorig:{Left|Right} Hips Spine Head Arm ForeArm Hand UpLeg Leg Foot",
    "three.js": "mixamorig{Left|Right} mixamorigHips mixamorigSpine mixamorigHead"
    " Arm ForeArm Hand UpLeg Leg Foot",
    "Acclaim": "{l|r} root lowerback head humerus radius wrist femur tibia foot",
    "VRoid": "J_Bip_{L|R}_ J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Head UpperArm LowerArm Hand"
    " UpperLeg LowerLeg Foot",
    "Unreal": "*_{l|r} pelvis spine_01 head upperarm lowerarm hand thigh calf foot",
    "Rigify": "*.{L|R} spine spine.001 spine.006 upper_arm forearm hand thigh shin foot",
    "Rigify deform": "*.{L|R} DEF-spine DEF-spine.001 DEF-spine.006 DEF-upper_arm DEF-forearm"
    " DEF-hand DEF-thigh DEF-shin DEF-foot",
    "Xsens": "{Left|Right} Pelvis L5 Head UpperArm ForeArm Hand UpperLeg LowerLeg Foot",
    "Rokoko": "{left|right} hips spine1 head Arm ForeArm Hand Thigh Shin Foot",
    "Azure": "*_{LEFT|RIGHT} PELVIS SPINE_NAVEL HEAD SHOULDER ELBOW WRIST HIP KNEE ANKLE",
    "Kinect v2": "*{Left|Right} SpineBase SpineMid Head Shoulder Elbow Wrist Hip Knee Ankle",
    "Kinect v1": "*{Left|Right} HipCenter Spine Head Shoulder Elbow Wrist Hip Knee Ankle",
    "Auto-Rig Pro": "*.{l|r} root.x spine_01.x head.x arm_stretch forearm_stretch hand"
    " thigh_stretch leg_stretch foot",
    "Biped": "Bip01~{L|R}~ Bip01~Pelvis Bip01~Spine Bip01~Head UpperArm Forearm Hand Thigh Calf"
    " Foot",
    "Character Creator": "CC_Base_{L|R}_ CC_Base_Hip CC_Base_Waist CC_Base_Head Upperarm"
    " Forearm Hand Thigh Calf Foot",
    "Blender": "*.{L|R} Hips Spine Head UpperArm LowerArm Hand UpperLeg LowerLeg Foot",
    "Poser": "{l|r} hip abdomen head Shldr ForeArm Hand Thigh Shin Foot",
    "UI-PRMD": "{L|R} Waist Spine Head UpArm ForeArm Hand UpLeg LowLeg Foot",
    "roles": "{left|right} hips spine head UpperArm LowerArm Hand UpperLeg LowerLeg Foot",
}
"""How each family writes a side; then hips, spine, head, and the limbs of one side."""


@pytest.mark.parametrize("family", FAMILIES)
def test_knows_the_names_of_each_family(family):
    expected = written_out(FAMILIES[family])

    found = roles_by_name([*expected.values(), "prop", "weapon", "cape_01", "cape_02"])

    assert {role: found.get(role) for role in ESSENTIAL_ROLES} == expected


def test_tells_vertebrae_and_backs_from_left_and_right():
    names = ["Pelvis", "L5", "L3", "T12", "T8", "lowerback", "root", "leg", "ribs"]

    assert not any(role.startswith(("left", "right")) for role in roles_by_name(names))


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


def test_five_vertebrae_of_unreal_5_are_spread_over_three_roles():
    names = [
        "pelvis",
        *(f"spine_0{i}" for i in range(1, 6)),
        "neck_01",
        "head",
        "ball_l",
        "ball_r",
    ]

    found = roles_by_name(names)

    assert [found[role] for role in ("spine", "chest", "upperChest")] == [
        "spine_01", "spine_03", "spine_05",
    ]  # fmt: skip
    assert found["leftToes"] == "ball_l"


@pytest.mark.parametrize(
    ("style", "finger"),
    [
        ("mixamorig:LeftHand{}{}", "Index"), ("{}_0{}_l", "index"), ("f_{}.0{}.L", "index"),
        ("lIndex{1}", ""), ("J_Bip_L_{}{}", "Index"),
    ],
)  # fmt: skip
def test_fingers_are_known_in_every_spelling(style, finger):
    names = [style.format(finger, number) for number in (1, 2, 3)]

    found = roles_by_name([*names, *(mirrored(name) for name in names)])

    parts = ("Proximal", "Intermediate", "Distal")
    assert [found[f"leftIndex{part}"] for part in parts] == names
    assert found["rightIndexDistal"] == mirrored(names[2])


def test_fingers_belong_to_the_hand_that_was_found():
    """A generated Rigify rig holds every bone several times over."""
    names = [
        f"{prefix}{bone}.{side}"
        for prefix in ("ORG-", "DEF-")
        for side in "LR"
        for bone in ("hand", "forearm", "f_ring.01", "f_ring.02", "f_ring.03")
    ]

    found = roles_by_name(names)

    assert found["leftHand"] == "DEF-hand.L"
    assert found["rightRingDistal"] == "DEF-f_ring.03.R"


def test_a_heel_is_no_toe(body):
    """Rigify hangs a heel on the foot, as low as the toes and behind them."""
    parents, offsets, names = list(body.parents), list(body.offsets), list(body.names)
    for side in ("Left", "Right"):
        names.append(f"{side}Heel")
        parents.append(body.index(f"{side}Foot"))
        offsets.append(np.array([0.0, 0.06, -0.08]))
    booted = Skeleton(tuple(names), tuple(parents), np.array(offsets))

    roles, _ = roles_by_structure(booted)

    assert roles["leftFoot"] == "LeftFoot"
    assert roles["rightToes"] == "RightToeBase"


def test_shape_answers_when_names_say_nothing(body):
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


def test_shape_does_not_depend_on_scale_or_place(body):
    offsets = 100.0 * body.offsets
    offsets[0] += (700.0, -50.0, 300.0)
    big = Skeleton(body.names, body.parents, offsets)

    assert roles_by_structure(big)[0] == roles_by_structure(body)[0]


def test_nothing_human_gives_an_empty_map():
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
def test_any_tree_of_any_names_is_answered(data):
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
    assert HumanoidMap(*roles_by_structure(skeleton)).score <= 1.0


def test_an_arm_alone_is_still_known_by_its_names():
    names = ("LeftArm", "LeftForeArm", "LeftHand")
    arm = Skeleton(names, (-1, 0, 1), np.array([[0, 0, 1.4], [0.3, 0, 0], [0.25, 0, 0]]))

    found = find_humanoid_map(arm)

    assert found.has("leftUpperArm", "leftLowerArm", "leftHand")
    assert found.score < 0.3


def test_names_on_the_wrong_parents_are_less_sure(body):
    parents = [max(parent, -1) if joint < 7 else 0 for joint, parent in enumerate(body.parents)]
    flat = Skeleton(body.names, tuple(parents), body.offsets)

    assert find_humanoid_map(flat).score < 0.7


def test_an_animator_can_correct_it(body):
    found = find_humanoid_map(body)

    edited = found.with_joint("neck", "Spine2").with_joint("head", None)

    assert edited.role("Spine2") == "neck"
    assert edited.joint("upperChest") is None
    assert edited.joint("head") is None
    assert found.joint("head") == "Head"


def test_travels_to_another_process(body):
    found = find_humanoid_map(body)

    assert pickle.loads(pickle.dumps(found)) == found


def test_cannot_be_changed_in_place():
    with pytest.raises(TypeError):
        HumanoidMap({"hips": "Hips"}).joints["head"] = "Head"


def test_refuses_unknown_roles_and_joints_with_two():
    with pytest.raises(InvalidMotionError, match="These are no humanoid roles: tail"):
        HumanoidMap({"tail": "Tail"})
    with pytest.raises(InvalidMotionError, match="more than one has Spine"):
        HumanoidMap({"chest": "Spine", "spine": "Spine"})


def test_roles_are_unique_and_hold_all_of_vrm():
    assert len(set(HUMANOID_ROLES)) == len(HUMANOID_ROLES) == 6 + 2 * (4 + 4 + 15)


def written_out(description: str) -> dict[str, str]:
    """Return joint names by essential role."""
    side, *words = description.split()
    hips, spine, head, *limbs = (word.replace("~", " ") for word in words)
    roles = {"hips": hips, "spine": spine, "head": head}
    before, _, rest = side.replace("~", " ").partition("{")
    choices, _, after = rest.partition("}")
    for role, written in zip(("left", "right"), choices.split("|"), strict=True):
        for part, limb in zip(LIMBS, limbs, strict=True):
            mark = before + written + after
            roles[role + part] = mark.replace("*", limb) if "*" in mark else mark + limb
    return {role: roles[role] for role in ESSENTIAL_ROLES}


def mirrored(name: str) -> str:
    for left, right in (("Left", "Right"), ("_l", "_r"), (".L", ".R"), ("_L_", "_R_")):
        if left in name:
            return name.replace(left, right)
    return "r" + name[1:]


def scrambled(skeleton: Skeleton) -> Skeleton:
    """Return the same skeleton with names that say nothing but where chains end."""
    names = [f"j{i}" for i in range(skeleton.n_joints)]
    for joint, parent in enumerate(skeleton.parents):
        if skeleton.is_end_site(joint):
            names[joint] = f"{names[parent]}_end"
    return Skeleton(tuple(names), skeleton.parents, skeleton.offsets)


def unscrambled(found: HumanoidMap, skeleton: Skeleton) -> dict[str, str]:
    return {role: skeleton.names[int(name[1:])] for role, name in found.joints.items()}


def bvh_skeleton(path) -> Skeleton:
    return read_bvh(path).skeleton
