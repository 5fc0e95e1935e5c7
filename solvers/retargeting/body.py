"""The part of a skeleton that plays humanoid roles, ready to be posed in canonical terms."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import HumanoidMap, Motion, Skeleton, t_pose_alignment
from .map_checks import check_feet, check_roles

Array = NDArray[np.float64]
SIDES = ("left", "right")
FEET = ("leftFoot", "rightFoot", "leftToes", "rightToes")


@dataclass(frozen=True, eq=False)
class Body:
    """Joints with a role, those above them, and the ends of feet and toes.

    Attributes
    ----------
    skeleton : Skeleton
        Of these joints only.
    kept : tuple of int
        Their indices in the whole skeleton.
    joints : dict of role to index in `skeleton`
    alignment : shape (n_joints, 4)
        World rotation from the canonical T-pose to the rest pose, of each joint.
    """

    skeleton: Skeleton
    kept: tuple[int, ...]
    joints: dict[str, int]
    alignment: Array

    @property
    def rest(self) -> Array:
        """Rotation centres in the rest pose, shape (n_joints, 3), metres."""
        return self.skeleton.rest_positions

    def limb(self, side: str, part: str) -> tuple[int, int, int] | None:
        """Return upper joint, hinge and end of an "Arm" or "Leg"; None for a broken one."""
        end = "Hand" if part == "Arm" else "Foot"
        roles = [f"{side}Upper{part}", f"{side}Lower{part}", f"{side}{end}"]
        if not all(role in self.joints for role in roles):
            return None
        upper, lower, last = (self.joints[role] for role in roles)
        skeleton = self.skeleton
        follow = upper in skeleton.ancestors(lower) and lower in skeleton.ancestors(last)
        limb = (upper, lower, last)
        usable = follow and skeleton.parents[upper] >= 0 and self.limb_length(limb) > 0.0
        return limb if usable else None

    def limb_length(self, limb: tuple[int, int, int]) -> float:
        """Return the way from the upper joint over the hinge to the end, metres."""
        return float(np.linalg.norm(np.diff(self.rest[list(limb)], axis=0), axis=-1).sum())

    def hip_joints(self) -> list[int]:
        """Return both upper legs, or the hips themselves where legs are not known."""
        roles = ("leftUpperLeg", "rightUpperLeg")
        known = [self.joints[role] for role in roles if role in self.joints]
        return known if len(known) == len(roles) else [self.joints["hips"]]


def find_body(skeleton: Skeleton, humanoid: HumanoidMap, whose: str) -> Body:
    """Return the body of a skeleton.

    Raises
    ------
    InvalidMotionError
        No joint plays the hips, a limb does not hang on them or is no chain, the head rests
        below them, arms and legs disagree about left and right, or the feet point backwards.
        `whose` skeleton it is stands in the sentence.
    """
    hips_of(skeleton, humanoid, whose)
    joints = humanoid.indices(skeleton)
    check_roles(skeleton, joints, whose)
    alignment = t_pose_alignment(skeleton, humanoid)
    check_feet(alignment, joints, whose)
    above = {up for joint in joints.values() for up in skeleton.ancestors(joint)}
    feet = [joints[role] for role in FEET if role in joints]
    tips = {child for foot in feet for child in skeleton.children[foot][:1]}
    kept = tuple(sorted({*joints.values(), *above, *tips, 0}))
    place = {joint: index for index, joint in enumerate(kept)}
    return Body(
        skeleton.select(kept),
        kept,
        {role: place[joint] for role, joint in joints.items()},
        alignment[list(kept)],
    )


def hips_of(skeleton: Skeleton, humanoid: HumanoidMap, whose: str) -> int:
    """Return the joint that plays the hips; see `find_body`."""
    if (hips := humanoid.indices(skeleton).get("hips")) is None:
        raise InvalidMotionError(
            f"No joint of the {whose} skeleton has the humanoid role hips. Choose one in the"
            " map."
        )
    return hips


def without_gaps(motion: Motion, body: Body) -> tuple[Motion, NDArray[np.bool_]]:
    """Return the body's motion with each gap held at the pose before it, and where gaps are.

    Before the first pose seen, that one is held; a joint never seen rests.

    Returns
    -------
    Motion, and bool array of shape (n_frames, n_joints): rotations that are not observed
    """
    rotations = motion.rotations[:, list(body.kept)]
    unknown = ~np.isfinite(rotations).all(axis=-1)
    for joint in np.flatnonzero(unknown.any(axis=0)):
        rotations[:, joint] = held(rotations[:, joint], (1.0, 0.0, 0.0, 0.0))
    places = held(motion.root_positions, body.rest[0])
    return Motion(body.skeleton, rotations, places, motion.frame_rate), unknown


def held(values: Array, otherwise: Array | tuple[float, ...]) -> Array:
    """Return values, shape (n_frames, n), in whose gaps the last one seen is held.

    The first one seen is held before it; `otherwise` stands for what is never seen.
    """
    known = np.isfinite(values).all(axis=-1)
    if not known.any():
        return np.tile(np.asarray(otherwise, dtype=np.float64), (len(values), 1))
    first = int(known.argmax())
    last = np.maximum.accumulate(np.where(known, np.arange(len(values)), first))
    return np.asarray(values[last])
