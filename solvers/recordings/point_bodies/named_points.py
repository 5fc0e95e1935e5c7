"""Recognize a body in points that a tracker has named in its own way."""

import re
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import roles_by_name
from ...motion.humanoid import SIDE_OF_WORD, SIDES
from ...motion.skeletons import BODY_POINTS, COMPUTED_JOINTS
from .mediapipe_landmarks import landmark_columns

PARTS = {
    "shoulder": "shoulder", "elbow": "elbow", "wrist": "wrist", "hip": "hip", "knee": "knee",
    "ankle": "ankle", "heel": "heel", "bigtoe": "foot_index", "footindex": "foot_index",
    "toe": "foot_index", "eye": "eye", "ear": "ear", "hand": "hand", "foot": "foot",
}  # fmt: skip
"""Keypoints of both sides, as MediaPipe calls them."""
ENDS = {"hand": "wrist", "foot": "ankle"}
"""Keypoints that some programs have in place of others."""
MIDDLE = {
    "nose": "nose", "neck": "neck_center", "midhip": "hips_center", "hips": "hips_center",
    "pelvis": "hips_center", "hipcenter": "hips_center", "hipscenter": "hips_center",
    "hip": "hips_center", "root": "hips_center", "head": "head_center",
    "headtop": "head_center", "centerhead": "head_center", "tophead": "head_center",
    "centershoulder": "neck_center",
}  # fmt: skip
OTHER_SIDE = {"l": "r", "r": "l", "L": "R", "R": "L"}
"""Last letters of names such as `hand_r`."""
LIMBS = tuple(
    f"{side}_{part}"
    for side in SIDES
    for part in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
)
"""Keypoints that a body must have."""
NAMES_OF_ROLES = {
    "hips": "pelvis", "spine": "spine1", "chest": "spine2", "upperChest": "spine3",
    "neck": "neck", "head": "head",
    **{f"{side}{role}": f"{side}_{name}" for side in SIDES for role, name in (
        ("Shoulder", "collar"), ("UpperArm", "shoulder"), ("LowerArm", "elbow"),
        ("Hand", "wrist"), ("UpperLeg", "hip"), ("LowerLeg", "knee"), ("Foot", "ankle"),
        ("Toes", "foot"),
    )},
}  # fmt: skip
"""Names of SMPL, by role."""
NEEDED_ROLES = frozenset(
    side + part
    for side in SIDES
    for part in ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
)
"""Roles that a body must have."""
PREFIX = re.compile(r".*[\W_]")
"""Words up to a separator."""
MIN_JOINTS = 3
"""Number of joints of a part of a body. By definition: those of a limb."""
MAX_MISSING = len(NEEDED_ROLES) // 2
"""Limbs that may lack in points whose names are those of a body. By definition the half: an
upper or a lower body is named like one."""


class NamedBody(NamedTuple):
    """Joints with names that this project knows."""

    names: tuple[str, ...]
    positions: Array
    """Shape (n_frames, n_joints, 3)."""


def body_of_named_points(names: Sequence[str], points: Array) -> NamedBody | None:
    """Return the body among named points; None if limbs are missing.

    Keypoints of image trackers, such as `LShoulder` or `left_hip`, get MediaPipe's names and
    the joints in the middle of the body; joints of skeletons get those of SMPL. Points without
    a role are left out.

    Parameters
    ----------
    names : length n_points
    points : shape (n_frames, n_points, 3)
    """
    if (landmarks := landmark_columns(names)) is not None:
        names, points = BODY_POINTS, points[:, landmarks]
    keypoints = _keypoints(without_prefix(names))
    if keypoints.keys() >= {*LIMBS}:
        return _with_centers({key: points[:, column] for key, column in keypoints.items()})
    roles = roles_by_name(names)
    if not roles.keys() >= NEEDED_ROLES:
        return None
    found = {
        NAMES_OF_ROLES[role]: points[:, list(names).index(name)]
        for role, name in roles.items()
        if role in NAMES_OF_ROLES
    }
    if "pelvis" not in found:
        middle = (found["left_hip"] + found["right_hip"]) / 2.0
        found["pelvis"] = (
            points[:, keypoints["hips_center"]] if "hips_center" in keypoints else middle
        )
    return NamedBody(tuple(found), np.stack(list(found.values()), axis=1))


def missing_limbs(names: Sequence[str]) -> list[str]:
    """Return the joints that named points lack of a body; empty if they are none at all.

    Points are those of a body if they have most of its limbs.
    """
    keypoints = _keypoints(without_prefix(names))
    by_kind = (
        [each for each in LIMBS if each not in keypoints],
        [NAMES_OF_ROLES[role] for role in NEEDED_ROLES - _roles(names).keys()],
    )
    shortest = min(by_kind, key=len)
    return sorted(shortest) if len(shortest) <= MAX_MISSING else []


def are_joints(names: Sequence[str]) -> bool:
    """Return whether these are names of several joints, of a body or a part of it."""
    known = {*_roles(names).values()}
    plain = without_prefix(names)
    return len(names) >= MIN_JOINTS and all(
        name in known or _keypoint(end) for name, end in zip(names, plain, strict=True)
    )


def n_known_names(names: Sequence[str]) -> int:
    """Return how many of these names are those of joints of a body."""
    return max(len(_roles(names)), len(_keypoints(without_prefix(names))))


def without_prefix(names: Sequence[str]) -> list[str]:
    """Return names without the words that all begin with, such as `body_`, but for a side."""
    first, last = min(names, default=""), max(names, default="")
    n_shared = next(
        (at for at, (a, b) in enumerate(zip(first, last, strict=False)) if a != b), 0
    )
    shared = PREFIX.match(first[:n_shared])
    if shared is None or not SIDE_OF_WORD.keys().isdisjoint(
        re.findall("[a-z]+", shared[0].lower())
    ):
        return list(names)
    return [name[shared.end() :] for name in names]


def _keypoints(names: Sequence[str]) -> dict[str, int]:
    """Return the columns of keypoints by MediaPipe's names.

    A hand or foot is the wrist or ankle of a side that lacks it, and a foot otherwise the toes.
    """
    keypoints: dict[str, int] = {}
    for column, name in enumerate(names):
        keypoints.setdefault(_keypoint(name), column)
    keypoints.pop("", None)
    for end, joint in ENDS.items():
        for side in SIDES:
            column = keypoints.pop(f"{side}_{end}", -1)
            if column < 0:
                continue
            if f"{side}_{joint}" not in keypoints:
                keypoints[f"{side}_{joint}"] = column
            elif end == "foot":  # next to an ankle, as of a Kinect
                keypoints.setdefault(f"{side}_foot_index", column)
    return keypoints


def _roles(names: Sequence[str]) -> dict[str, str]:
    """Return points by their roles, also where only those of one side are there."""
    mirrored = [
        name[:-1] + OTHER_SIDE[name[-1]]
        for name in names
        if name[-1:] in OTHER_SIDE and not name[-2:-1].isalnum()
    ]
    roles = roles_by_name([*dict.fromkeys([*names, *mirrored])])
    return {role: name for role, name in roles.items() if name in names}


def _keypoint(name: str) -> str:
    """Return MediaPipe's name of a keypoint; empty if it has none."""
    words = [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]
    plain = "".join(words)
    if plain in MIDDLE:
        return MIDDLE[plain]
    for side in (words[0], words[-1]) if len(words) > 1 else ():
        rest = "".join(words[1:] if side is words[0] else words[:-1])
        if side in SIDE_OF_WORD and rest in PARTS:
            return f"{SIDE_OF_WORD[side]}_{PARTS[rest]}"
    if plain[:1] in SIDE_OF_WORD and plain[1:] in PARTS:  # such as rshoulder
        return f"{SIDE_OF_WORD[plain[0]]}_{PARTS[plain[1:]]}"
    return ""


def _with_centers(joints: dict[str, Array]) -> NamedBody:
    for center, sides in COMPUTED_JOINTS.items():
        if center not in joints and joints.keys() >= {*sides}:
            joints[center] = np.mean([joints[side] for side in sides], axis=0)
    return NamedBody(tuple(joints), np.stack(list(joints.values()), axis=1))
