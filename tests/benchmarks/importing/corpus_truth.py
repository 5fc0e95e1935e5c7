"""What is known of the recordings of other makers, and what a take shows that differs."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatch

import numpy as np

HEIGHT_TOLERANCE = 0.15
MIN_UPRIGHT = 0.8
"""Cosine between the trunk and the vertical in most frames of an actor who stands."""
MAX_OFF_FLOOR_M = 0.15
"""Height of the lowest joint of an actor who stands, in most frames."""
EXCUSES = {
    "height": "interpreted as|m tall",
    "lies": "taken for up",
    "rate": "is assumed|frame rate",
    "floor": "floor",
}
"""What a report must say about a fault, so that it is not a silent one."""

SIDES = {"left": ("Left", "left", "L", "l"), "right": ("Right", "right", "R", "r")}
LIMBS = ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
MIXAMO = "Hips Head *UpLeg *Leg *Foot *Arm *ForeArm *Hand"
"""Names of hips, head and the joints of the limbs; the asterisk is the side."""
BIOVISION = "Hips Head *Hip *Knee *Ankle *Shoulder *Elbow *Wrist"
LIFE_FORMS = "Hips Head *UpLeg *LowLeg *Foot *UpArm *LowArm *Hand"


@dataclass(frozen=True)
class Truth:
    """What is known of a file."""

    height_m: float | None = None
    """Of the tallest joint above the lowest in most frames; None where it is no body."""
    rate_hz: float | None = None
    joints: str = ""
    """Hips, head and joints of the limbs (`LIMBS`); empty where there are no bones."""
    stands: bool = True
    refused: bool = False


REFUSED = Truth(refused=True)
NO_PERSON = Truth()
TRUTH = {
    "bvh/assimp_boxing_toes/*": Truth(1.62, 100.0, BIOVISION),
    "bvh/bandai_namco/*": Truth(
        1.38, 30.0, "Hips Head UpperLeg_* LowerLeg_* Foot_* UpperArm_* LowerArm_* Hand_*"
    ),
    "bvh/dme_*/*": Truth(1.38, 120.0, MIXAMO),
    "bvh/ganimator_crab/*": NO_PERSON,
    "bvh/mixamo_bvh_joe/*": Truth(1.9, 60.0, MIXAMO),
    "bvh/olympe_*/*": Truth(1.67, 24.0, LIFE_FORMS),
    "bvh/pybvh_test1/*": Truth(1.64, 30.0, MIXAMO),
    "bvh/pybvh_test3/*": Truth(1.62, 120.0, MIXAMO),
    "bvh/smpl_momask/*": Truth(
        1.42, 60.0, "Pelvis Head *_hip *_knee *_ankle *_shoulder *_elbow *_wrist"
    ),
    "bvh/smpl_template/*": Truth(1.42, 60.0, MIXAMO),
    "bvh/xsens_mvn/*": Truth(1.53, 60.0, BIOVISION),
    "dae/*": NO_PERSON,
    "fbx/assimp_skeleton/*": NO_PERSON,
    "fbx/max7_skin/*": NO_PERSON,
    "fbx/mixamo_web/Rolling.fbx": Truth(0.9, 30.0, MIXAMO, stands=False),
    "fbx/mixamo_web/*": Truth(1.9, 30.0, MIXAMO),
    "fbx/ue4_mannequin/*": REFUSED,
    "glb/khronos_cesiumman/*": Truth(
        1.13,
        24.0,
        "Skeleton_torso_joint_1 Skeleton_neck_joint_2 leg_joint_*_1 leg_joint_*_2"
        " leg_joint_*_3 Skeleton_arm_joint_L__4_/Skeleton_arm_joint_R"
        " Skeleton_arm_joint_L__3_/Skeleton_arm_joint_R__2_"
        " Skeleton_arm_joint_L__2_/Skeleton_arm_joint_R__3_",
    ),
    "glb/mixamo_blender/*": Truth(1.68, 30.0, MIXAMO),
    "glb/khronos_riggedsimple/*": NO_PERSON,
    "glb/m2m_quadruped_fox/*": NO_PERSON,
    "lab/c3d_bts/*": Truth(1.5, 100.0),
    "lab/c3d_qualisys/*": Truth(1.47, 200.0),
    "lab/c3d_rotation/*": Truth(
        1.65, 85.0, "pelvis head *_thigh *_shank *_foot *_uarm *_larm *_hand"
    ),
    "lab/openpose_json/*": REFUSED,
    "lab/pose2sim/*.trc": Truth(1.67, 60.0),
    "lab/pose2sim/*": REFUSED,
    "lab/c3d_vicon/*": Truth(0.78, 100.0, stands=False),
    "lab/pyomeca_csv/markers.csv": Truth(0.78, 100.0, stands=False),
    "lab/pyomeca_csv/*": Truth(0.65, 100.0, stands=False),
    "lab/xsens_mvnx/*": Truth(
        1.36,
        60.0,
        "Pelvis Head *UpperLeg *LowerLeg *Foot *UpperArm *ForeArm *Hand",
    ),
    "smpl/aist_pkl/*": REFUSED,
    "smpl/humanml3d_263/*": REFUSED,
    "smpl/kimodo_soma_npz/*": Truth(
        1.6, 30.0, "Hips Head *Leg *Shin *Foot *Arm *ForeArm *Hand"
    ),
    "udp/*": REFUSED,
    "usd/*": NO_PERSON,
    "vrm/vrma_pixiv/*": Truth(
        1.56, 30.0, "hips head *UpperLeg *LowerLeg *Foot *UpperArm *LowerArm *Hand"
    ),
    "vrm/*": REFUSED,
    "formats/bvh/11_01.bvh": Truth(
        1.4, 120.0, "hip head *Thigh *Shin *Foot *Shldr *ForeArm *Hand"
    ),
    "formats/bvh/2017-10-19-11-14-48.bvh": Truth(
        1.43, 30.0, "Hip Head Hip* Knee* Ankle* Shoulder* Elbow* Wrist*"
    ),
    "formats/bvh/milad.bvh": Truth(1.7, 125.0, MIXAMO),
    "formats/bvh/optitrack_louise.bvh": Truth(1.4, 100.0, BIOVISION, stands=False),
    "formats/bvh/test_mocapbank.bvh": Truth(1.3, 30.0, BIOVISION, stands=False),
    "formats/bvh/xsens_walk.bvh": Truth(1.74, 100.0, BIOVISION),
    "formats/c3d/parameterOverflow.c3d": REFUSED,
    "formats/trc/futureOrientation*": REFUSED,
}
"""By path below the corpus; of other files only what their markers say is known."""

TOP_MARKERS = r"(head|[lr][fb]hd|c7|clav|[lr]acr|acr|[lr]sho|r\.?should(er)?|l\.?should(er)?)"
FOOT_MARKERS = r"([lr]\.?(ank(le)?|mall?|hee(l)?|toe|cal|foot|met)|[lr]f[lt]1)"
"""Names of markers on the upper trunk and on the feet, without blanks, in lower case."""


def truth_of(name: str) -> Truth | None:
    """Return what is known of a file, by its path below the corpus."""
    return next((truth for pattern, truth in TRUTH.items() if fnmatch(name, pattern)), None)


def faults_of(
    figures: Mapping[str, float], joints: Mapping[str, str], truth: Truth | None, message: str
) -> list[str]:
    """Return what differs from the truth and is not said.

    Parameters
    ----------
    figures : of a take
    joints : name of the joint of each role
    truth : of the file; None if nothing is known
    message : the warnings of the reader
    """
    if truth is None:
        faults = ["lies"] * (figures.get("upright", 1.0) < 0.0)
    elif truth.refused:
        return ["read"]
    elif truth.height_m is None:
        return ["taken for a person"] * (figures.get("score", 0.0) >= 0.5)
    else:
        faults = _faults_of_person(figures, truth)
        faults += ["roles"] * (joints != {**joints, **true_joints(truth, joints)})
    return [
        fault for fault in faults if not re.search(EXCUSES.get(fault, "^$"), message or "-")
    ]


def _faults_of_person(figures: Mapping[str, float], truth: Truth) -> list[str]:
    height = figures.get("height", np.nan)
    faults = ["height"] * (not abs(height / (truth.height_m or 1.0) - 1.0) <= HEIGHT_TOLERANCE)
    faults += ["lies"] * (truth.stands and figures.get("upright", 1.0) < MIN_UPRIGHT)
    faults += ["rate"] * (truth.rate_hz not in {None, round(figures["rate"], 3)})
    faults += ["floor"] * (truth.stands and abs(figures["low"]) > MAX_OFF_FLOOR_M)
    return faults


def true_joints(truth: Truth, joints: Mapping[str, str]) -> dict[str, str]:
    """Return the right joint of each role that is known, with the prefix of the skeleton."""
    if not truth.joints:
        return {}
    hips, head, *limbs = truth.joints.split()
    prefix = joints.get("hips", "").removesuffix(hips)
    right = {"hips": hips, "head": head}
    for part, pattern in zip(LIMBS, limbs, strict=True):
        by_side = pattern.split("/")
        for number, (side, words) in enumerate(SIDES.items()):
            name = by_side[number] if len(by_side) > 1 else pattern
            word = next(
                (each for each in words if name.replace("*", each) in joints.values()),
                words[0],
            )
            right[side + part] = name.replace("*", word)
    return {role: prefix + name for role, name in right.items()}
