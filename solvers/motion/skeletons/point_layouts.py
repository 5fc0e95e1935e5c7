"""The order of the joints in arrays that data sets and pose estimators store without names.

Sources: the keypoint lists of COCO, Halpe-FullBody, OpenPose (BODY_25), CMU Panoptic, MPII and
LSP; data/skeleton.py of VideoPose3D (Human3.6M), and of SemGCN (without neck);
metadata/mhr70.py of SAM 3D Body (MHR 70); MPI-INF-3DHP (mpii_get_joint_set "relevant"); the KIT
motion-language data set; extract.py of LaFAN1. Joints have the names that this project has for
them: those of Microsoft's cameras, MediaPipe or SMPL.
"""

from .body_trackers import SMPL, SMPL_HANDS, ZED_34, ZED_38
from .depth_sensors import AZURE_KINECT, KINECT_V1, KINECT_V2, UI_PRMD
from .mediapipe import BODY_POINTS

_LEFT, _RIGHT = "left_", "right_"
_ARM, _LEG = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
_EYES = ("left_eye", "right_eye", "left_ear", "right_ear")
_KINECT_ARM, _KINECT_LEG = ("Shoulder", "Elbow", "Wrist"), ("Hip", "Knee", "Ankle")


def _side(prefix: str, *parts: str) -> tuple[str, ...]:
    return tuple(prefix + part for part in parts)


def _pairs(*parts: str) -> tuple[str, ...]:
    return tuple(prefix + part for part in parts for prefix in (_LEFT, _RIGHT))


def _kinect(side: str, *parts: str) -> tuple[str, ...]:
    return tuple(part + side for part in parts)


_COCO = ("nose", *_EYES, *_pairs(*_ARM, *_LEG))
_H36M_17 = (
    "SpineBase", *_kinect("Right", *_KINECT_LEG), *_kinect("Left", *_KINECT_LEG), "SpineMid",
    "SpineShoulder", "Neck", "Head", *_kinect("Left", *_KINECT_ARM),
    *_kinect("Right", *_KINECT_ARM),
)  # fmt: skip
_H36M_32 = (
    "SpineBase", *_kinect("Right", *_KINECT_LEG, "Foot"), "",
    *_kinect("Left", *_KINECT_LEG, "Foot"), "", "", "SpineMid", "SpineShoulder", "Neck", "Head",
    "", *_kinect("Left", *_KINECT_ARM), "", "", "", "", "", *_kinect("Right", *_KINECT_ARM),
    "", "", "", "",
)  # fmt: skip
_BODY_25 = (
    "nose", "neck_center", *_side(_RIGHT, *_ARM), *_side(_LEFT, *_ARM), "hips_center",
    *_side(_RIGHT, *_LEG), *_side(_LEFT, *_LEG), "right_eye", "left_eye", "right_ear",
    "left_ear", "left_foot_index", "", "left_heel", "right_foot_index", "", "right_heel",
)  # fmt: skip
_PANOPTIC = (
    "neck_center", "nose", "hips_center", *_side(_LEFT, *_ARM), *_side(_LEFT, *_LEG),
    *_side(_RIGHT, *_ARM), *_side(_RIGHT, *_LEG), "left_eye", "left_ear", "right_eye",
    "right_ear",
)  # fmt: skip
_LSP = (
    "right_ankle", "right_knee", "right_hip", "left_hip", "left_knee", "left_ankle",
    "right_wrist", "right_elbow", "right_shoulder", "left_shoulder", "left_elbow", "left_wrist",
    "neck_center", "head_center",
)  # fmt: skip
_MPII = (
    "AnkleRight", "KneeRight", "HipRight", "HipLeft", "KneeLeft", "AnkleLeft", "SpineBase",
    "SpineShoulder", "Neck", "Head", "WristRight", "ElbowRight", "ShoulderRight",
    "ShoulderLeft", "ElbowLeft", "WristLeft",
)  # fmt: skip
_MPI_INF = (
    "", "SpineShoulder", *_kinect("Right", *_KINECT_ARM), *_kinect("Left", *_KINECT_ARM),
    *_kinect("Right", *_KINECT_LEG), *_kinect("Left", *_KINECT_LEG), "SpineBase", "SpineMid",
    "Head",
)  # fmt: skip
_KIT = (
    "SpineBase", "SpineMid", "SpineShoulder", "Neck", "Head", *_kinect("Left", *_KINECT_ARM),
    *_kinect("Right", *_KINECT_ARM), *_kinect("Left", *_KINECT_LEG), "", "FootLeft",
    *_kinect("Right", *_KINECT_LEG), "", "FootRight",
)  # fmt: skip
_LAFAN = (
    "pelvis", *_side(_LEFT, *_LEG, "foot"), *_side(_RIGHT, *_LEG, "foot"), "spine1", "spine2",
    "spine3", "neck", "head", *_side(_LEFT, "collar", *_ARM), *_side(_RIGHT, "collar", *_ARM),
)  # fmt: skip

_MHR_70 = (
    "nose", *_EYES, *_pairs("shoulder", "elbow", *_LEG), "left_foot_index", "", "left_heel",
    "right_foot_index", "", "right_heel", *[""] * 20, "right_wrist", *[""] * 20, "left_wrist",
    *[""] * 6, "neck_center",
)  # fmt: skip
"""SAM 3D Body; between ankles and wrists are fingers, after them elbows and shoulders."""

LAYOUTS: dict[str, tuple[str, ...]] = {
    "LSP": _LSP,
    "MPII": _MPII,
    "Human3.6M": _H36M_17,
    "Human3.6M without neck": (*_H36M_17[:9], *_H36M_17[10:]),
    "COCO": _COCO,
    "MPI-INF-3DHP": _MPI_INF,
    "OpenPose": (*_BODY_25[:8], *_BODY_25[9:19]),
    "CMU Panoptic": _PANOPTIC,
    "Kinect v1": tuple(KINECT_V1),
    "UTD-MHAD": (*tuple(KINECT_V1)[3::-1], *tuple(KINECT_V1)[4:]),
    "KIT": _KIT,
    "SMPL": tuple(SMPL)[:22],
    "LaFAN1": _LAFAN,
    "UI-PRMD": tuple(UI_PRMD),
    "SMPL with hands": tuple(SMPL),
    "Kinect v2 or NTU": tuple(KINECT_V2),
    "BODY_25": _BODY_25,
    "Halpe": (
        *_COCO, "head_center", "neck_center", "hips_center", *_pairs("foot_index"), "", "",
        *_pairs("heel"),
    ),
    "Azure Kinect": tuple(AZURE_KINECT),
    "Human3.6M with ends": _H36M_32,
    "MediaPipe": BODY_POINTS,
    "ZED 34": ZED_34,
    "ZED 38": ZED_38,
    "SMPL-H": (*tuple(SMPL)[:22], *SMPL_HANDS),
    "SMPL-X": (*tuple(SMPL)[:22], "", "", "", *SMPL_HANDS),
    "MHR 70": _MHR_70,
}  # fmt: skip
"""Names in the order of each layout; points without a name are left out."""
