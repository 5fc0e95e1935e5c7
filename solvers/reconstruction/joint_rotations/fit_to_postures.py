"""A motion of any rig, turned so that its body goes where postures say."""

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import (
    HumanoidMap,
    Motion,
    find_humanoid_map,
    forward_kinematics,
    local_rotations,
)
from ...motion.humanoid import CHEST, HIPS, N_JOINTS, POSTURE_JOINTS, motion_postures
from ...rotations import best_turns, inverse, multiply, rotate, rotation_between, slerp
from ...signals import bridged, bridged_rotations

Array = NDArray[np.float64]
AIMS = {
    f"{side}{part}": f"{side}{end}"
    for side in ("left", "right")
    for part, end in (
        ("Shoulder", "UpperArm"), ("UpperArm", "LowerArm"), ("LowerArm", "Hand"),
        ("UpperLeg", "LowerLeg"), ("LowerLeg", "Foot"), ("Foot", "Toes"),
    )
} | {"neck": "head"}  # fmt: skip
"""Roles that point at another one."""
PELVIS = tuple(
    POSTURE_JOINTS.index(role) for role in ("leftUpperLeg", "rightUpperLeg", "spine")
)
TRUNK = tuple(POSTURE_JOINTS.index(role) for role in ("leftUpperArm", "rightUpperArm", "head"))
MIN_LENGTH_M = 1e-3
"""Metres. Ways that are shorter tell no direction."""


def fit_motion_to_postures(
    motion: Motion, postures: Array, humanoid_map: HumanoidMap | None = None
) -> Motion:
    """Turn a motion the short way until its body is where postures say.

    Pelvis and chest turn as hips and shoulders do, the spine between them by shares; limbs
    point at the place of their child. All else, twist too, stays as it was: hands and fingers
    go along with the forearm. Gaps are bridged first.

    Parameters
    ----------
    motion : Motion
    postures : shape (n_frames, 20, 3), metres
        Where `POSTURE_JOINTS` are to be; NaN: anywhere.
    humanoid_map : HumanoidMap, optional
        Found by `find_humanoid_map` where it is not given.

    Returns
    -------
    Motion
        Of the same skeleton.

    Raises
    ------
    InvalidMotionError
        The postures do not fit the motion, or the skeleton lacks hips, arms or legs.
    """
    if postures.shape != (motion.n_frames, N_JOINTS, 3):
        raise InvalidMotionError(
            f"Postures for this motion need shape ({motion.n_frames}, {N_JOINTS}, 3), not"
            f" {postures.shape}."
        )
    humanoid_map = humanoid_map or find_humanoid_map(motion.skeleton)
    whole = fill_gaps(motion)
    return _PostureFit(whole, postures, humanoid_map).followed()


def fill_gaps(motion: Motion) -> Motion:
    """Bridge gaps the short way, joint by joint; before and after all that is known, hold."""
    places = np.nan_to_num(bridged(motion.root_positions))
    return motion.with_poses(bridged_rotations(motion.rotations), places)


class _PostureFit:
    """A motion whose joints are turned anew, parents first."""

    def __init__(self, motion: Motion, postures: Array, humanoid_map: HumanoidMap) -> None:
        self.motion, self.skeleton = motion, motion.skeleton
        self.old = forward_kinematics(motion)
        self.before = motion_postures(motion, humanoid_map)
        self.wanted = np.where(np.isfinite(postures), postures, self.before)
        places = humanoid_map.indices(self.skeleton)
        self.roles = {joint: role for role, joint in places.items()}
        self.places = places
        arms = [
            self.skeleton.ancestors(places[f"{side}UpperArm"]) for side in ("left", "right")
        ]
        self.chest = next(joint for joint in arms[0] if joint in arms[1])
        chain = [self.chest, *self.skeleton.ancestors(self.chest)]
        self.hips = places["hips"]
        self.trunk = chain[: chain.index(self.hips) + 1][::-1]
        self.turns = np.tile((1.0, 0.0, 0.0, 0.0), (motion.n_frames, motion.n_joints, 1))
        """How each joint turns in the world, on top of how it was turned."""
        self.at = np.array(self.old.positions)

    def followed(self) -> Motion:
        pelvis, chest = self._laid(HIPS, PELVIS), self._laid(CHEST, TRUNK)
        moved = self.wanted[:, HIPS] - self.before[:, HIPS]
        for joint, parent in enumerate(self.skeleton.parents):
            if parent < 0:
                self.at[:, joint] += moved
            else:
                way = self.old.positions[:, joint] - self.old.positions[:, parent]
                self.at[:, joint] = self.at[:, parent] + rotate(self.turns[:, parent], way)
                self.turns[:, joint] = self.turns[:, parent]
            if joint in self.trunk:
                share = self.trunk.index(joint) / max(len(self.trunk) - 1, 1)
                self.turns[:, joint] = slerp(pelvis, chest, share)
                if 0.0 < share < 1.0:
                    self.turns[:, joint] = self._aimed(joint, self.chest, CHEST)
            elif (role := AIMS.get(self.roles.get(joint, ""), "")) in self.places:
                child = self.places[role]
                self.turns[:, joint] = self._aimed(joint, child, POSTURE_JOINTS.index(role))
        world = multiply(self.turns, self.old.rotations)
        rotations = local_rotations(self.skeleton, world)
        root = self.motion.root_positions + moved
        return self.motion.with_poses(rotations, root)

    def _laid(self, middle: int, around: tuple[int, ...]) -> Array:
        """Return the turn that lays joints about one of the trunk where they are to be."""
        old = self.before[:, around] - self.before[:, [middle]]
        new = self.wanted[:, around] - self.wanted[:, [middle]]
        told = np.isfinite(old).all(axis=(0, 2)) & np.isfinite(new).all(axis=(0, 2))
        rest = np.median(old[:, told], axis=0)
        turns = multiply(
            best_turns(rest, new[:, told]), inverse(best_turns(rest, old[:, told]))
        )
        return np.where(np.isfinite(turns), turns, (1.0, 0.0, 0.0, 0.0))

    def _aimed(self, joint: int, goal: int, place: int) -> Array:
        """Turn a joint so much farther that one below it comes into line with its place."""
        above = self.turns[:, joint]
        astray = self.old.positions[:, goal] - self.before[:, place]
        rest = rotate(above, self.old.positions[:, goal] - self.old.positions[:, joint])
        way = self.wanted[:, place] + astray - self.at[:, joint]
        sizes = [np.linalg.norm(each, axis=-1, keepdims=True) for each in (rest, way)]
        told = np.isfinite(way).all(axis=-1, keepdims=True) & (
            np.minimum(*sizes) > MIN_LENGTH_M
        )
        swing = rotation_between(np.where(told, rest, 1.0), np.where(told, way, 1.0))
        return np.where(told, multiply(swing, above), above)
