"""Joint names of every rig family are recognized in all spellings of sides and numbers."""

import pytest

from solvers.motion import roles_by_name
from solvers.motion.humanoid.roles import ESSENTIAL_ROLES

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
def test_names_of_each_family_have_their_roles(family):
    expected = written_out(FAMILIES[family])

    found = roles_by_name([*expected.values(), "prop", "weapon", "cape_01", "cape_02"])

    assert {role: found.get(role) for role in ESSENTIAL_ROLES} == expected


def test_the_prefix_of_a_body_among_more_hair_and_clothes_is_ignored():
    """MotionBuilder calls a body Character1; games give it hair, skirts and ribbons."""
    plain = written_out(FAMILIES["Mixamo"].replace("mixamorig:", ""))
    expected = {role: f"Character1_{name}" for role, name in plain.items()}
    hair = [f"J_{side}_Hair{lock}_0{n}" for side in "LR" for lock in range(8) for n in range(4)]

    found = roles_by_name(["Root", *expected.values(), *hair])

    assert {role: found.get(role) for role in ESSENTIAL_ROLES} == expected


@pytest.mark.parametrize("prefixes", [("IK_", "FK_", "DEF_"), ("Cloth_", "Char_")])
def test_no_body_is_preferred_where_several_have_the_same_names(prefixes):
    """The first one in the file was it, with full confidence."""
    body = list(written_out(FAMILIES["Mixamo"].replace("mixamorig:", "")).values())

    found = roles_by_name(["Root", *(prefix + name for prefix in prefixes for name in body)])

    assert not set(ESSENTIAL_ROLES) <= found.keys()


def test_vertebrae_and_backs_are_not_mistaken_for_sides():
    names = ["Pelvis", "L5", "L3", "T12", "T8", "lowerback", "root", "leg", "ribs"]

    assert not any(role.startswith(("left", "right")) for role in roles_by_name(names))


def test_five_vertebrae_of_unreal_5_have_three_roles():
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
def test_fingers_are_recognized_in_every_spelling(style, finger):
    names = [style.format(finger, number) for number in (1, 2, 3)]

    found = roles_by_name([*names, *(mirrored(name) for name in names)])

    parts = ("Proximal", "Intermediate", "Distal")
    assert [found[f"leftIndex{part}"] for part in parts] == names
    assert found["rightIndexDistal"] == mirrored(names[2])


def test_fingers_belong_to_the_recognized_hand():
    """A generated Rigify rig contains every bone several times."""
    names = [
        f"{prefix}{bone}.{side}"
        for prefix in ("ORG-", "DEF-")
        for side in "LR"
        for bone in ("hand", "forearm", "f_ring.01", "f_ring.02", "f_ring.03")
    ]

    found = roles_by_name(names)

    assert found["leftHand"] == "DEF-hand.L"
    assert found["rightRingDistal"] == "DEF-f_ring.03.R"


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


@pytest.mark.parametrize(
    "pattern",
    ["{}_109", "{}.001", "{}_JNT", "jnt_{}_JNT", "{}_bind_01", "Spring_Ring_{}", "Char1:{}_02"],
)
def test_fingers_keep_their_roles_where_all_names_share_words(pattern):
    """An exporter that adds "_109" to every bone hid the number of the finger's joint."""
    names = [
        "Hips", "Spine", "Neck", "Head",
        *(side + limb for side in ("Left", "Right")
          for limb in ("UpLeg", "Leg", "Foot", "Shoulder", "Arm", "ForeArm", "Hand")),
        *(f"{side}Hand{finger}{number}" for side in ("Left", "Right")
          for finger in ("Thumb", "Index", "Middle", "Ring", "Pinky")
          for number in range(1, 5)),
    ]  # fmt: skip
    plain = roles_by_name(names)
    assert sum("Proximal" in role for role in plain) == 10

    found = roles_by_name([pattern.format(name) for name in names])

    assert found == {role: pattern.format(name) for role, name in plain.items()}
