"""Names of the rigs that animators retarget to."""

import pytest

from solvers.motion import find_humanoid_map, roles_by_name

SIDED = {
    "Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes",
    "IndexProximal", "ThumbMetacarpal",
}  # fmt: skip


# Roles with their names, the side as {}; then names that play no role.
FAMILIES: dict[str, tuple[str, str, str]] = {
    "CMU": (
        "Left Right",
        "hips=Hips spine=LowerBack chest=Spine upperChest=Spine1 neck=Neck head=Head"
        " Shoulder={}Shoulder UpperArm={}Arm LowerArm={}ForeArm Hand={}Hand"
        " UpperLeg={}UpLeg LowerLeg={}Leg Foot={}Foot Toes={}ToeBase",
        "LHipJoint RHipJoint Neck1 {}FingerBase {}HandIndex1",
    ),
    "HDM05": (
        "l r",
        "hips=root spine=lowerback chest=upperback upperChest=thorax neck=lowerneck head=head"
        " Shoulder={}clavicle UpperArm={}humerus LowerArm={}radius Hand={}hand"
        " UpperLeg={}femur LowerLeg={}tibia Foot={}foot Toes={}toes",
        "{}hipjoint upperneck {}wrist {}fingers {}thumb",
    ),
    "Mixamo": (
        "Left Right",
        "hips=mixamorig:Hips spine=mixamorig:Spine chest=mixamorig:Spine1"
        " upperChest=mixamorig:Spine2 neck=mixamorig:Neck head=mixamorig:Head"
        " Shoulder=mixamorig:{}Shoulder UpperArm=mixamorig:{}Arm LowerArm=mixamorig:{}ForeArm"
        " Hand=mixamorig:{}Hand UpperLeg=mixamorig:{}UpLeg LowerLeg=mixamorig:{}Leg"
        " Foot=mixamorig:{}Foot Toes=mixamorig:{}ToeBase"
        " IndexProximal=mixamorig:{}HandIndex1 ThumbMetacarpal=mixamorig:{}HandThumb1",
        "mixamorig:HeadTop_End mixamorig:{}Toe_End mixamorig:{}HandThumb4"
        " +mixamorig:{}HandIndex2 +mixamorig:{}HandIndex3 +mixamorig:{}HandThumb2"
        " +mixamorig:{}HandThumb3 mixamorig:{}Eye",
    ),
    "Unreal Mannequin": (
        "l r",
        "hips=pelvis spine=spine_01 chest=spine_02 upperChest=spine_03 neck=neck_01 head=head"
        " Shoulder=clavicle_{} UpperArm=upperarm_{} LowerArm=lowerarm_{} Hand=hand_{}"
        " UpperLeg=thigh_{} LowerLeg=calf_{} Foot=foot_{} Toes=ball_{}"
        " IndexProximal=index_01_{} ThumbMetacarpal=thumb_01_{}",
        "root upperarm_twist_01_{} lowerarm_twist_01_{} thigh_twist_01_{} calf_twist_01_{}"
        " ik_foot_root ik_foot_{} ik_hand_root ik_hand_gun ik_hand_{} +index_02_{} +index_03_{}"
        " +thumb_02_{} +thumb_03_{}",
    ),
    "VRM": (
        "L R",
        "hips=J_Bip_C_Hips spine=J_Bip_C_Spine chest=J_Bip_C_Chest"
        " upperChest=J_Bip_C_UpperChest neck=J_Bip_C_Neck head=J_Bip_C_Head"
        " Shoulder=J_Bip_{}_Shoulder UpperArm=J_Bip_{}_UpperArm LowerArm=J_Bip_{}_LowerArm"
        " Hand=J_Bip_{}_Hand UpperLeg=J_Bip_{}_UpperLeg LowerLeg=J_Bip_{}_LowerLeg"
        " Foot=J_Bip_{}_Foot Toes=J_Bip_{}_ToeBase IndexProximal=J_Bip_{}_Index1"
        " ThumbMetacarpal=J_Bip_{}_Thumb1",
        "Root J_Sec_Hair1_01 J_Adj_{}_FaceEye J_Sec_{}_Bust1 +J_Bip_{}_Index2 +J_Bip_{}_Index3"
        " +J_Bip_{}_Thumb2 +J_Bip_{}_Thumb3",
    ),
    "Xsens": (
        "Left Right",
        "hips=Pelvis spine=L5 chest=T12 upperChest=T8 neck=Neck head=Head Shoulder={}Shoulder"
        " UpperArm={}UpperArm LowerArm={}ForeArm Hand={}Hand UpperLeg={}UpperLeg"
        " LowerLeg={}LowerLeg Foot={}Foot Toes={}Toe",
        "L3",
    ),
    "Rokoko": (
        "Left Right",
        "hips=Hips spine=Spine1 chest=Spine2 upperChest=Spine4 neck=Neck head=Head"
        " Shoulder={}Shoulder UpperArm={}Arm LowerArm={}ForeArm Hand={}Hand UpperLeg={}Thigh"
        " LowerLeg={}Shin Foot={}Foot Toes={}Toe",
        "Spine3",
    ),
    "Perception Neuron": (
        "Left Right",
        "hips=Robot_Hips spine=Robot_Spine chest=Robot_Spine1 upperChest=Robot_Spine3"
        " neck=Robot_Neck head=Robot_Head Shoulder=Robot_{}Shoulder UpperArm=Robot_{}Arm"
        " LowerArm=Robot_{}ForeArm Hand=Robot_{}Hand UpperLeg=Robot_{}UpLeg"
        " LowerLeg=Robot_{}Leg Foot=Robot_{}Foot",
        "Robot_Spine2 Robot_{}InHandIndex",
    ),
    "Auto-Rig Pro": (
        "l r",
        "hips=root.x spine=spine_01.x chest=spine_02.x upperChest=spine_03.x neck=neck.x"
        " head=head.x Shoulder=shoulder.{} UpperArm=arm_stretch.{} LowerArm=forearm_stretch.{}"
        " Hand=hand.{} UpperLeg=thigh_stretch.{} LowerLeg=leg_stretch.{} Foot=foot.{}"
        " Toes=toes_01.{}",
        "arm_twist.{} forearm_twist.{} thigh_twist.{} leg_twist.{} c_traj",
    ),
    "Auto-Rig Pro controls": (
        "l r",
        "hips=c_root_master.x spine=c_spine_01.x chest=c_spine_02.x upperChest=c_spine_03.x"
        " neck=c_neck.x head=c_head.x Shoulder=c_shoulder.{} UpperArm=c_arm_fk.{}"
        " LowerArm=c_forearm_fk.{} Hand=c_hand_fk.{} UpperLeg=c_thigh_fk.{}"
        " LowerLeg=c_leg_fk.{} Foot=c_foot_fk.{} Toes=c_toes_fk.{}",
        "c_pos c_traj c_root.x c_arm_ik.{} c_hand_ik.{} c_foot_ik.{} c_leg_ik.{} c_toes_ik.{}",
    ),
    "Rigify controls": (
        "L R",
        "hips=torso spine=spine_fk.002 chest=spine_fk.003 neck=neck head=head"
        " Shoulder=shoulder.{} UpperArm=upper_arm_fk.{} LowerArm=forearm_fk.{}"
        " Hand=hand_fk.{} UpperLeg=thigh_fk.{} LowerLeg=shin_fk.{} Foot=foot_fk.{}"
        " Toes=toe_fk.{}",
        "root hips chest spine_fk spine_fk.001 tweak_spine tweak_spine.001 upper_arm_tweak.{}"
        " upper_arm_parent.{} upper_arm_ik.{} hand_ik.{} foot_ik.{} toe_ik.{} foot_heel_ik.{}"
        " foot_spin_ik.{} thigh_ik.{} upper_arm_ik_target.{} palm.{} breast.{}",
    ),
    "Rigify deform bones": (
        "L R",
        "hips=DEF-spine spine=DEF-spine.001 chest=DEF-spine.002 upperChest=DEF-spine.003"
        " neck=DEF-spine.004 head=DEF-spine.006 Shoulder=DEF-shoulder.{}"
        " UpperArm=DEF-upper_arm.{} LowerArm=DEF-forearm.{} Hand=DEF-hand.{}"
        " UpperLeg=DEF-thigh.{} LowerLeg=DEF-shin.{} Foot=DEF-foot.{} Toes=DEF-toe.{}",
        "DEF-spine.005 DEF-upper_arm.{}.001 DEF-forearm.{}.001 DEF-thigh.{}.001"
        " DEF-shin.{}.001 DEF-pelvis.{} DEF-breast.{} DEF-jaw DEF-palm.01.{}",
    ),
    "Rigify organisation bones": (
        "L R",
        "hips=ORG-spine spine=ORG-spine.001 chest=ORG-spine.002 upperChest=ORG-spine.003"
        " neck=ORG-spine.004 head=ORG-spine.006 Shoulder=ORG-shoulder.{}"
        " UpperArm=ORG-upper_arm.{} LowerArm=ORG-forearm.{} Hand=ORG-hand.{}"
        " UpperLeg=ORG-thigh.{} LowerLeg=ORG-shin.{} Foot=ORG-foot.{} Toes=ORG-toe.{}",
        "ORG-spine.005 ORG-pelvis.{} ORG-heel.02.{} ORG-breast.{} ORG-face ORG-palm.01.{}",
    ),
    "Kinect v1": (
        "Left Right",
        "hips=HipCenter spine=Spine neck=ShoulderCenter head=Head UpperArm=Shoulder{}"
        " LowerArm=Elbow{} Hand=Wrist{} UpperLeg=Hip{} LowerLeg=Knee{} Foot=Ankle{}"
        " Toes=Foot{}",
        "Hand{}",
    ),
    "Kinect v2": (
        "Left Right",
        "hips=SpineBase spine=SpineMid chest=SpineShoulder neck=Neck head=Head"
        " UpperArm=Shoulder{} LowerArm=Elbow{} Hand=Wrist{} UpperLeg=Hip{} LowerLeg=Knee{}"
        " Foot=Ankle{} Toes=Foot{}",
        "Hand{} HandTip{} Thumb{}",
    ),
    "Azure Kinect": (
        "LEFT RIGHT",
        "hips=PELVIS spine=SPINE_NAVEL chest=SPINE_CHEST neck=NECK head=HEAD"
        " Shoulder=CLAVICLE_{} UpperArm=SHOULDER_{} LowerArm=ELBOW_{} Hand=WRIST_{}"
        " UpperLeg=HIP_{} LowerLeg=KNEE_{} Foot=ANKLE_{} Toes=FOOT_{}",
        "HAND_{} HANDTIP_{} THUMB_{} NOSE EYE_{} EAR_{}",
    ),
}


@pytest.mark.parametrize("family", FAMILIES)
def test_roles_are_assigned_to_the_expected_names_only(family):
    sides, described, others = FAMILIES[family]
    expected, extra = written_out(sides.split(), described, others)
    names = [*expected.values(), *extra]

    found = roles_by_name(names)

    assert {role: found.get(role) for role in expected} == expected
    idle = [name for name, more in extra.items() if not more]
    assert not set(idle) & set(found.values())


@pytest.mark.parametrize("family", FAMILIES)
def test_roles_do_not_depend_on_the_order_of_names(family):
    sides, described, others = FAMILIES[family]
    expected, extra = written_out(sides.split(), described, others)

    found = roles_by_name([*reversed(extra), *reversed(expected.values())])

    assert {role: found.get(role) for role in expected} == expected


def test_names_of_a_complete_rig_have_full_confidence(body):
    assert find_humanoid_map(body).score == 1.0


def written_out(
    sides: list[str], described: str, others: str
) -> tuple[dict[str, str], dict[str, bool]]:
    """Return names by role, and further names with whether they may have one ("+")."""
    expected = {}
    for role, name in (word.split("=") for word in described.split()):
        if role in SIDED:
            for prefix, side in zip(("left", "right"), sides, strict=True):
                expected[prefix + role] = name.format(side)
        else:
            expected[role] = name
    extra = {}
    for word in others.split():
        for side in sides if "{}" in word else [""]:
            extra[word.removeprefix("+").format(side)] = word.startswith("+")
    return expected, extra
