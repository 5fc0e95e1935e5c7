"""The twenty joints that postures are made of: those of the first Kinect, named by their roles.

All that is learned of postures is told in these joints, so that whatever tracks at least them
(each Kinect, and any skeleton with humanoid roles) can be compared with whatever else does.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ..skeletons import JointRecording, Motion, Skeleton, Tracks, forward_kinematics
from .names import roles_by_name
from .roles import HumanoidMap, find_humanoid_map

Array = NDArray[np.float64]

POSTURE_JOINTS = (
    "hips", "spine", "chest", "head",
    "leftUpperArm", "leftLowerArm", "leftHand", "leftHandEnd",
    "rightUpperArm", "rightLowerArm", "rightHand", "rightHandEnd",
    "leftUpperLeg", "leftLowerLeg", "leftFoot", "leftToes",
    "rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes",
)  # fmt: skip
"""Humanoid roles, by which the joint is meant where that bone begins; "chest" is the point
between the shoulders, and a "HandEnd" the middle of the hand or what comes after the wrist."""

PARENTS = (-1, 0, 1, 2, 2, 4, 5, 6, 2, 8, 9, 10, 0, 12, 13, 14, 0, 16, 17, 18)
N_JOINTS = len(POSTURE_JOINTS)
MIRROR_JOINTS = (0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15)
"""The joint of the other side; joints of the middle are their own."""
HIPS, SPINE, CHEST = 0, 1, 2

BETWEEN_SHOULDERS = ("SpineShoulder", "Chest", "SpineChest", "ShoulderCenter")
"""What trackers call the point between the shoulders; the first that is there."""
HAND_ENDS = ("HandLeft", "HandRight")
SIDES = ("left", "right")
PALM = 0.13
"""Metres from the wrist within which the end of a hand is looked for."""


def posture_joint_indices(names: Sequence[str]) -> dict[str, int]:
    """Return which of these tracked joints plays which of `POSTURE_JOINTS`."""
    return dict(_found(tuple(names)))


@lru_cache(maxsize=64)
def _found(names: tuple[str, ...]) -> tuple[tuple[str, int], ...]:
    """Return roles and joints; a solve asks many times for the same names."""
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
    """Return where the joints of postures are, shape (n_frames, 20, 3); NaN: not tracked.

    Raises
    ------
    InvalidMotionError
        The recording has no hips, or no joint besides them.
    """
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    places = posture_joint_indices(tracks.names)
    if "hips" not in places or len(places) < 2:
        raise InvalidMotionError(
            "No body was recognised in the names of the joints"
            f" ({', '.join(tracks.names[:4])} ...); they must be those of a Kinect, or"
            " humanoid roles, and hips must be among them."
        )
    positions = np.full((tracks.n_frames, N_JOINTS, 3), np.nan)
    for role, place in places.items():
        positions[:, POSTURE_JOINTS.index(role)] = tracks.positions[:, place]
    return positions


def postures_from_motion(motion: Motion, humanoid_map: HumanoidMap | None = None) -> Array:
    """Return where the joints of postures are in a motion, shape (n_frames, 20, 3), metres.

    "chest" is the joint that both arms hang on, "spine" that half way to it from the hips, and
    a "HandEnd" what is farthest from the wrist within half a hand's length.

    Raises
    ------
    InvalidMotionError
        The skeleton lacks hips, arms or legs.
    """
    skeleton = motion.skeleton
    places = (humanoid_map or find_humanoid_map(skeleton)).indices(skeleton)
    needed = [f"{side}{part}" for side in SIDES for part in ("UpperArm", "UpperLeg")]
    if lost := [role for role in ("hips", *needed) if role not in places]:
        raise InvalidMotionError(
            f"The skeleton has no joint for {', '.join(lost)}; postures are those of bodies"
            " with two arms and two legs."
        )
    played = {role: place for role, place in places.items() if role in POSTURE_JOINTS}
    arms = [skeleton.ancestors(places[f"{side}UpperArm"]) for side in SIDES]
    played["chest"] = next(joint for joint in arms[0] if joint in arms[1])
    played["spine"] = _half_way(skeleton, places["hips"], played["chest"])
    for side in SIDES:
        if f"{side}Hand" in played:
            played[f"{side}HandEnd"] = _hand_end(skeleton, played[f"{side}Hand"])
    world = forward_kinematics(motion).positions
    positions = np.full((motion.n_frames, N_JOINTS, 3), np.nan)
    for role, place in played.items():
        positions[:, POSTURE_JOINTS.index(role)] = world[:, place]
    return positions


def _half_way(skeleton: Skeleton, hips: int, chest: int) -> int:
    """Return the joint between hips and chest that rests nearest to the middle."""
    rest = skeleton.rest_positions
    chain = [chest, *skeleton.ancestors(chest)]
    between = chain[: chain.index(hips) + 1]
    middle = (rest[hips] + rest[chest]) / 2.0
    return min(between, key=lambda joint: float(np.linalg.norm(rest[joint] - middle)))


def _hand_end(skeleton: Skeleton, wrist: int) -> int:
    """Return what hangs on the wrist farthest from it, as far as the palm reaches."""
    rest = skeleton.rest_positions
    ways = {
        joint: float(np.linalg.norm(rest[joint] - rest[wrist]))
        for joint in skeleton.subtree(wrist)
    }
    return max((joint for joint in ways if ways[joint] <= PALM), key=ways.__getitem__)
