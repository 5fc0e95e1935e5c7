"""Points that MediaPipe finds in an image, and their joint hierarchy.

Sources: mediapipe/python/solutions/pose.py (PoseLandmark), hands.py (HandLandmark). It finds no
joint on the midline of the body; four are computed like the virtual markers of freemocap:
means of the points on both sides.
"""

BODY_POINTS = (
    "nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye",
    "right_eye_outer", "left_ear", "right_ear", "mouth_left", "mouth_right", "left_shoulder",
    "right_shoulder", "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_pinky",
    "right_pinky", "left_index", "right_index", "left_thumb", "right_thumb", "left_hip",
    "right_hip", "left_knee", "right_knee", "left_ankle", "right_ankle", "left_heel",
    "right_heel", "left_foot_index", "right_foot_index",
)  # fmt: skip
"""Points of the body in MediaPipe's order."""
FINGERS = ("thumb", "index", "middle", "ring", "pinky")
HAND_POINTS = ("wrist", *(f"{finger}_{part}" for finger in FINGERS for part in (1, 2, 3, 4)))
"""Points of one hand in MediaPipe's order, without the prefix left_hand_ or right_hand_."""

HIPS = ("left_hip", "right_hip")
SHOULDERS = ("left_shoulder", "right_shoulder")
COMPUTED_JOINTS = {
    "hips_center": HIPS,
    "trunk_center": (*HIPS, *SHOULDERS),
    "neck_center": SHOULDERS,
    "head_center": ("left_ear", "right_ear"),
}
"""Computed joints, each the mean of the listed points."""

_FACE = (*BODY_POINTS[:9], "mouth_left", "mouth_right")
_LIMBS = {
    "shoulder": "neck_center", "elbow": "shoulder", "wrist": "elbow",
    "pinky": "wrist", "index": "wrist", "thumb": "wrist",
    "hip": "hips_center", "knee": "hip", "ankle": "knee", "heel": "ankle",
    "foot_index": "ankle",
}  # fmt: skip


def _parents() -> dict[str, str]:
    """Return each joint's parent; empty for the root."""
    parents = {
        "hips_center": "", "trunk_center": "hips_center", "neck_center": "trunk_center",
        "head_center": "neck_center", **dict.fromkeys(_FACE, "head_center"),
    }  # fmt: skip
    for side in ("left", "right"):
        for joint, parent in _LIMBS.items():
            parents[f"{side}_{joint}"] = (
                parent if parent in COMPUTED_JOINTS else f"{side}_{parent}"
            )
        for finger in FINGERS:
            chain = [f"{side}_hand_{finger}_{part}" for part in (1, 2, 3, 4)]
            parents |= zip(chain, [f"{side}_wrist", *chain], strict=False)
    return parents


MEDIAPIPE = _parents()
"""Each joint and its parent. A hand's wrist is not a joint: it duplicates the body's."""

# Directions from the parent in a T-pose that faces -Y; see `depth_sensors.rest_direction`.
_OUT, _DOWN, _THUMB = (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.6, -0.8, 0.0)
MEDIAPIPE_T_POSE = {
    **dict.fromkeys(("left_hip", "left_shoulder", "left_elbow", "left_wrist"), _OUT),
    **dict.fromkeys(("left_knee", "left_ankle"), _DOWN),
    **{f"left_hand_{part}": _OUT for part in HAND_POINTS},
    **{f"left_hand_thumb_{part}": _THUMB for part in (1, 2, 3, 4)},
    "left_thumb": _THUMB, "left_index": (1.0, -0.3, 0.0), "left_pinky": (1.0, 0.3, 0.0),
    "left_heel": (0.0, 0.5, -1.0), "left_foot_index": (0.0, -1.0, -0.5),
    "nose": (0.0, -1.0, -0.1), "left_ear": _OUT,
    "left_eye_inner": (0.2, -0.9, 0.3), "left_eye": (0.3, -0.9, 0.3),
    "left_eye_outer": (0.4, -0.9, 0.3), "mouth_left": (0.2, -0.9, -0.4),
}  # fmt: skip
