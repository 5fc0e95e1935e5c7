"""Joints that body trackers find in depth images, in the order of each tracker.

Sources: NuiSensor.h of the Kinect for Windows SDK 1.8 (NUI_SKELETON_POSITION_INDEX), Kinect.h
of the SDK 2.0 (JointType), k4abttypes.h of the Azure Kinect Body Tracking SDK 1.1
(k4abt_joint_id_t), whose names are spelled here like those of the other two.
"""

import re
from collections.abc import Sequence
from enum import Enum

from .body_trackers import SMPL, SMPL_HANDS, SMPL_T_POSE, ZED_T_POSE, zed_parents
from .mediapipe import MEDIAPIPE, MEDIAPIPE_T_POSE


class Sensor(Enum):
    """Camera or body tracker that a joint recording comes from."""

    KINECT_V1 = "kinect_v1"
    KINECT_V2 = "kinect_v2"
    AZURE_KINECT = "azure_kinect"
    MEDIAPIPE = "mediapipe"
    ZED = "zed"
    NUITRACK = "nuitrack"
    OTHER = "other"


# Each row is a joint and its parent, in the order of the tracker's joint indices.
KINECT_V1 = {
    "HipCenter": "", "Spine": "HipCenter", "ShoulderCenter": "Spine", "Head": "ShoulderCenter",
    "ShoulderLeft": "ShoulderCenter", "ElbowLeft": "ShoulderLeft", "WristLeft": "ElbowLeft",
    "HandLeft": "WristLeft",
    "ShoulderRight": "ShoulderCenter", "ElbowRight": "ShoulderRight",
    "WristRight": "ElbowRight", "HandRight": "WristRight",
    "HipLeft": "HipCenter", "KneeLeft": "HipLeft", "AnkleLeft": "KneeLeft",
    "FootLeft": "AnkleLeft",
    "HipRight": "HipCenter", "KneeRight": "HipRight", "AnkleRight": "KneeRight",
    "FootRight": "AnkleRight",
}  # fmt: skip
KINECT_V2 = {
    "SpineBase": "", "SpineMid": "SpineBase", "Neck": "SpineShoulder", "Head": "Neck",
    "ShoulderLeft": "SpineShoulder", "ElbowLeft": "ShoulderLeft", "WristLeft": "ElbowLeft",
    "HandLeft": "WristLeft",
    "ShoulderRight": "SpineShoulder", "ElbowRight": "ShoulderRight", "WristRight": "ElbowRight",
    "HandRight": "WristRight",
    "HipLeft": "SpineBase", "KneeLeft": "HipLeft", "AnkleLeft": "KneeLeft",
    "FootLeft": "AnkleLeft",
    "HipRight": "SpineBase", "KneeRight": "HipRight", "AnkleRight": "KneeRight",
    "FootRight": "AnkleRight",
    "SpineShoulder": "SpineMid",
    "HandTipLeft": "HandLeft", "ThumbLeft": "WristLeft",
    "HandTipRight": "HandRight", "ThumbRight": "WristRight",
}  # fmt: skip
AZURE_KINECT = {
    "Pelvis": "", "SpineNavel": "Pelvis", "SpineChest": "SpineNavel", "Neck": "SpineChest",
    "ClavicleLeft": "SpineChest", "ShoulderLeft": "ClavicleLeft", "ElbowLeft": "ShoulderLeft",
    "WristLeft": "ElbowLeft", "HandLeft": "WristLeft", "HandTipLeft": "HandLeft",
    "ThumbLeft": "WristLeft",
    "ClavicleRight": "SpineChest", "ShoulderRight": "ClavicleRight",
    "ElbowRight": "ShoulderRight", "WristRight": "ElbowRight", "HandRight": "WristRight",
    "HandTipRight": "HandRight", "ThumbRight": "WristRight",
    "HipLeft": "Pelvis", "KneeLeft": "HipLeft", "AnkleLeft": "KneeLeft",
    "FootLeft": "AnkleLeft",
    "HipRight": "Pelvis", "KneeRight": "HipRight", "AnkleRight": "KneeRight",
    "FootRight": "AnkleRight",
    "Head": "Neck", "Nose": "Head", "EyeLeft": "Head", "EarLeft": "Head", "EyeRight": "Head",
    "EarRight": "Head",
}  # fmt: skip
UI_PRMD = {  # Kinect v2, with the joint names of the UI-PRMD data set
    "Waist": "", "Spine": "Waist", "Chest": "Spine", "Neck": "Chest", "Head": "Neck",
    "HeadTip": "Head",
    "LCollar": "Chest", "LUpArm": "LCollar", "LForeArm": "LUpArm", "LHand": "LForeArm",
    "RCollar": "Chest", "RUpArm": "RCollar", "RForeArm": "RUpArm", "RHand": "RForeArm",
    "LUpLeg": "Waist", "LLowLeg": "LUpLeg", "LFoot": "LLowLeg", "LToes": "LFoot",
    "RUpLeg": "Waist", "RLowLeg": "RUpLeg", "RFoot": "RLowLeg", "RToes": "RFoot",
}  # fmt: skip
ZED = zed_parents(AZURE_KINECT)

SENSOR_JOINTS = {
    Sensor.KINECT_V1: tuple(KINECT_V1),
    Sensor.KINECT_V2: tuple(KINECT_V2),
    Sensor.AZURE_KINECT: tuple(AZURE_KINECT),
}
"""Joint names of each sensor, in the order of the tracker's joint indices."""

# Directions from the parent to a left or central joint, in a T-pose that faces -Y.
UP, DOWN, OUT = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0)
T_POSE = {
    "HipLeft": (1.0, 0.0, -0.5), "LUpLeg": (1.0, 0.0, -0.5),
    "KneeLeft": DOWN, "AnkleLeft": DOWN, "LLowLeg": DOWN, "LFoot": DOWN,
    "FootLeft": (0.0, -1.0, -0.5), "LToes": (0.0, -1.0, -0.5),
    "ClavicleLeft": (0.4, 0.0, 1.0), "LCollar": (0.4, 0.0, 1.0),
    "ShoulderLeft": OUT, "ElbowLeft": OUT, "WristLeft": OUT, "HandLeft": OUT,
    "HandTipLeft": OUT, "LUpArm": OUT, "LForeArm": OUT, "LHand": OUT,
    "ThumbLeft": (0.6, -0.8, 0.0),
    "Nose": (0.0, -1.0, 0.2), "EyeLeft": (0.3, -0.9, 0.5), "EarLeft": (0.8, -0.1, 0.3),
    **MEDIAPIPE_T_POSE, **ZED_T_POSE, **SMPL_T_POSE,
}  # fmt: skip


def rest_direction(name: str) -> tuple[float, float, float]:
    """Return the unit direction from a joint's parent to it, in a T-pose that faces -Y.

    Joints without an entry in the table, such as those of the spine, point up.
    """
    left_name = re.sub("^R(?=[A-Z])", "L", name)
    left_name = left_name.replace("Right", "Left").replace("right", "left")
    x, y, z = T_POSE.get(left_name, UP)
    length = (x * x + y * y + z * z) ** 0.5
    return (x if left_name == name else -x) / length, y / length, z / length


def joint_parents(names: Sequence[str]) -> tuple[int, ...]:
    """Return the index of each joint's parent among `names`; -1 for a joint without one.

    The hierarchy is that of the tracker with most of the names. A joint whose parent is left
    out is a child of its nearest ancestor in `names`. In the order of the Kinect v2 a parent
    may come after its children.
    """
    tables = (
        KINECT_V2, KINECT_V1, AZURE_KINECT, ZED, UI_PRMD, MEDIAPIPE, SMPL | SMPL_HANDS,
    )  # fmt: skip
    table = max(tables, key=lambda known: len(known.keys() & set(names)))
    indices = {name: index for index, name in enumerate(names)}
    parents = []
    for name in names:
        parent = table.get(name, "")
        while parent and parent not in indices:
            parent = table[parent]
        parents.append(indices.get(parent, -1))
    return tuple(parents)
