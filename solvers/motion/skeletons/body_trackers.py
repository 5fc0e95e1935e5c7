"""Joints of body trackers that name more joints than Microsoft's cameras.

Sources: the enumerations BODY_18_PARTS, BODY_34_PARTS and BODY_38_PARTS of the ZED SDK 4, and
JointType of Nuitrack; joints that the Azure Kinect has too are called as there. JOINT_NAMES of
smplx for the video models that find an SMPL body.
"""

_SIDES = ("Left", "Right")
ZED_SIDES = {
    "HeelLeft": "AnkleLeft", "SmallToeLeft": "AnkleLeft", "IndexLeft": "WristLeft",
    "PinkyLeft": "WristLeft",
}  # fmt: skip
"""Joints of the left side, and their parents, that only the ZED has."""


def zed_parents(azure: dict[str, str]) -> dict[str, str]:
    """Return each joint and its parent, in addition to those of the Azure Kinect."""
    right = {
        name.replace("Left", "Right"): parent.replace("Left", "Right")
        for name, parent in ZED_SIDES.items()
    }
    trunk = {"SpineChest": "SpineMiddle", "SpineMiddle": "SpineNavel"}
    return azure | trunk | ZED_SIDES | right


ZED_T_POSE = {
    "HeelLeft": (0.0, 0.5, -1.0), "SmallToeLeft": (0.3, -1.0, -0.5),
    "IndexLeft": (1.0, -0.3, 0.0), "PinkyLeft": (1.0, 0.3, 0.0),
}  # fmt: skip
"""Directions from the parent; see `depth_sensors.rest_direction`."""

ZED_18 = (
    "Nose", "Neck", "ShoulderRight", "ElbowRight", "WristRight", "ShoulderLeft", "ElbowLeft",
    "WristLeft", "HipRight", "KneeRight", "AnkleRight", "HipLeft", "KneeLeft", "AnkleLeft",
    "EyeRight", "EyeLeft", "EarRight", "EarLeft",
)  # fmt: skip
ZED_34 = (
    "Pelvis", "SpineNavel", "SpineChest", "Neck",
    *(f"{joint}{side}" for side in _SIDES
      for joint in ("Clavicle", "Shoulder", "Elbow", "Wrist", "Hand", "HandTip", "Thumb")),
    *(f"{joint}{side}" for side in _SIDES for joint in ("Hip", "Knee", "Ankle", "Foot")),
    "Head", "Nose", "EyeLeft", "EarLeft", "EyeRight", "EarRight", "HeelLeft", "HeelRight",
)  # fmt: skip
ZED_38 = (
    "Pelvis", "SpineNavel", "SpineMiddle", "SpineChest", "Neck", "Nose",
    *(f"{joint}{side}"
      for joint in ("Eye", "Ear", "Clavicle", "Shoulder", "Elbow", "Wrist", "Hip", "Knee",
                    "Ankle", "Foot", "SmallToe", "Heel", "Thumb", "Index", "HandTip", "Pinky")
      for side in _SIDES),
)  # fmt: skip
ZED_BODIES = {len(names): names for names in (ZED_18, ZED_34, ZED_38)}
"""Names of the joints in the order of the SDK, by their number."""

_ARM = {
    "COLLAR": "Clavicle", "SHOULDER": "Shoulder", "ELBOW": "Elbow", "WRIST": "Wrist",
    "HAND": "Hand", "FINGERTIP": "HandTip",
}  # fmt: skip
_LEG = {"HIP": "Hip", "KNEE": "Knee", "ANKLE": "Ankle", "FOOT": "Foot"}
NUITRACK = {"HEAD": "Head", "NECK": "Neck", "TORSO": "SpineNavel", "WAIST": "Pelvis"} | {
    f"{side.upper()}_{joint}": f"{name}{side}"
    for limb in (_ARM, _LEG)
    for side in _SIDES
    for joint, name in limb.items()
}
"""Our names of Nuitrack's joints, in the order of its numbers, which begin with 1."""

_SMPL_SIDE = {
    "collar": "spine3", "shoulder": "collar", "elbow": "shoulder", "wrist": "elbow",
    "hand": "wrist", "hip": "pelvis", "knee": "hip", "ankle": "knee", "foot": "ankle",
}  # fmt: skip
_SMPL_ORDER = (
    "pelvis", "left_hip", "right_hip", "spine1", "left_knee", "right_knee", "spine2",
    "left_ankle", "right_ankle", "spine3", "left_foot", "right_foot", "neck", "left_collar",
    "right_collar", "head", "left_shoulder", "right_shoulder", "left_elbow", "right_elbow",
    "left_wrist", "right_wrist", "left_hand", "right_hand",
)  # fmt: skip


def _smpl_parent(name: str) -> str:
    side, _, part = name.partition("_")
    if part in _SMPL_SIDE:
        parent = _SMPL_SIDE[part]
        return f"{side}_{parent}" if parent in _SMPL_SIDE else parent
    trunk = {"spine1": "pelvis", "spine2": "spine1", "spine3": "spine2", "neck": "spine3"}
    return "neck" if name == "head" else trunk.get(name, "")


SMPL = {name: _smpl_parent(name) for name in _SMPL_ORDER}
"""Each joint of SMPL and its parent, in its order."""
SMPL_HANDS = {
    f"{side}_{finger}{joint}": f"{side}_{finger}{joint - 1}" if joint > 1 else f"{side}_wrist"
    for side in ("left", "right")
    for finger in ("index", "middle", "pinky", "ring", "thumb")
    for joint in (1, 2, 3)
}
"""Each joint of the hands of SMPL-H and SMPL-X and its parent, in their order."""
SMPL_T_POSE = {
    "left_collar": (0.4, 0.0, 1.0), "left_foot": (0.0, -1.0, -0.5),
    "left_hand": (1.0, 0.0, 0.0),
    **{name: (0.6, -0.8, 0.0) if "thumb" in name else (1.0, 0.0, 0.0)
       for name in SMPL_HANDS if name.startswith("left")},
}  # fmt: skip
"""Directions from the parent; see `depth_sensors.rest_direction`."""
