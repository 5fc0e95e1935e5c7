"""The twenty joints of a posture: those of the first Kinect, named by humanoid roles.

All posture models use these joints, so that every source with at least these joints (each
Kinect, and any skeleton with humanoid roles) can be compared.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ..skeletons import JointRecording, Motion, Skeleton, Tracks, forward_kinematics
from .names import roles_by_name
from .roles import HumanoidMap, find_humanoid_map
from .tables import SIDES

POSTURE_JOINTS = (
    "hips", "spine", "chest", "head",
    "leftUpperArm", "leftLowerArm", "leftHand", "leftHandEnd",
    "rightUpperArm", "rightLowerArm", "rightHand", "rightHandEnd",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
"""Humanoid roles, each for the joint at the start of that bone. "chest" is the point between
the shoulders, "HandEnd" the middle of the hand or the joint after the wrist."""

PARENTS = (-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18)
N_JOINTS = len(POSTURE_JOINTS)
MIRROR_JOINTS = (0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15)
"""Index of the joint on the other side; central joints have their own index."""
HIPS, SPINE, CHEST = 0, 1, 2

BETWEEN_SHOULDERS = ("SpineShoulder", "Chest", "SpineChest", "ShoulderCenter")
"""Names of the point between the shoulders; the first one present is used."""
HAND_ENDS = ("HandLeft", "HandRight")
MAX_HAND_END_M = 0.13
"""Maximum distance of the end of a hand from the wrist. It guards against hands without a palm;
a hand is 0.108 of the height (Winter 2009)
(`test_hand_ends_at_the_palm_not_at_the_finger_tips`)."""


def posture_joint_indices(names: Sequence[str]) -> dict[str, int]:
    """Return the index in `names` of each of the `POSTURE_JOINTS`."""
    return dict(_cached_indices(tuple(names)))


@lru_cache(maxsize=64)
def _cached_indices(names: tuple[str, ...]) -> tuple[tuple[str, int], ...]:
    """Return roles and indices, cached because a solve queries the same names many times."""
    roles = dict(roles_by_name(names))
    between = [name for name in BETWEEN_SHOULDERS if name in names]
    if between or "neck" in roles:
        roles["chest"] = between[0] if between else roles["neck"]
    if "HeadTip" in names:
        roles["head"] = "HeadTip"
    for side, name in zip(SIDES, HAND_ENDS, strict=True):
        if name in names and roles.get(f"{side}Hand") != name:
            roles[f"{side}HandEnd"] = name
    roles |= {name: name for name in names if name in POSTURE_JOINTS}
    return tuple((role, names.index(roles[role])) for role in POSTURE_JOINTS if role in roles)


def posture_positions(recording: JointRecording | Tracks) -> Array:
    """Return the positions of the posture joints, shape (n_frames, 20, 3); NaN: missing.

    Raises
    ------
    InvalidMotionError
        The recording has no hips, or no other posture joint.
    """
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    indices = posture_joint_indices(tracks.names)
    if "hips" not in indices or len(indices) < 2:
        raise InvalidMotionError(
            "No body was recognized in the names of the joints"
            f" ({', '.join(tracks.names[:4])} ...); they must be those of a Kinect, or"
            " humanoid roles, and hips must be among them."
        )
    positions = np.full((tracks.n_frames, N_JOINTS, 3), np.nan)
    for role, index in indices.items():
        positions[:, POSTURE_JOINTS.index(role)] = tracks.positions[:, index]
    return positions


def postures_from_motion(motion: Motion, humanoid_map: HumanoidMap | None = None) -> Array:
    """Return the positions of the posture joints of a motion, shape (n_frames, 20, 3), meters.

    "chest" is the common ancestor of both arms, "spine" the joint nearest to the middle between
    it and the hips, "HandEnd" the farthest descendant of the wrist within the hand.

    Raises
    ------
    InvalidMotionError
        The skeleton lacks hips, arms or legs.
    """
    skeleton = motion.skeleton
    indices = (humanoid_map or find_humanoid_map(skeleton)).indices(skeleton)
    needed = [f"{side}{part}" for side in SIDES for part in ("UpperArm", "UpperLeg")]
    if missing := [role for role in ("hips", *needed) if role not in indices]:
        raise InvalidMotionError(
            f"The skeleton has no joint for {', '.join(missing)}; postures need a body"
            " with two arms and two legs."
        )
    selected = {role: index for role, index in indices.items() if role in POSTURE_JOINTS}
    arms = [skeleton.ancestors(indices[f"{side}UpperArm"]) for side in SIDES]
    selected["chest"] = next(joint for joint in arms[0] if joint in arms[1])
    selected["spine"] = _middle_joint(skeleton, indices["hips"], selected["chest"])
    for side in SIDES:
        if f"{side}Hand" in selected:
            selected[f"{side}HandEnd"] = _hand_end(skeleton, selected[f"{side}Hand"])
    world = forward_kinematics(motion).positions
    positions = np.full((motion.n_frames, N_JOINTS, 3), np.nan)
    for role, index in selected.items():
        positions[:, POSTURE_JOINTS.index(role)] = world[:, index]
    return positions


def _middle_joint(skeleton: Skeleton, hips: int, chest: int) -> int:
    """Return the joint between hips and chest that rests nearest to the middle."""
    rest = skeleton.rest_positions
    chain = [chest, *skeleton.ancestors(chest)]
    between = chain[: chain.index(hips) + 1]
    middle = (rest[hips] + rest[chest]) / 2.0
    return min(between, key=lambda joint: float(np.linalg.norm(rest[joint] - middle)))


def _hand_end(skeleton: Skeleton, wrist: int) -> int:
    """Return the farthest descendant of the wrist within the length of the palm."""
    rest = skeleton.rest_positions
    distances = {
        joint: float(np.linalg.norm(rest[joint] - rest[wrist]))
        for joint in skeleton.subtree(wrist)
    }
    return max(
        (joint for joint in distances if distances[joint] <= MAX_HAND_END_M),
        key=distances.__getitem__,
    )
