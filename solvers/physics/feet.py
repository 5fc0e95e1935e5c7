"""Soles for the feet of a simulated body, and where the ground is: both as the take shows."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..motion import (
    HumanoidMap,
    Motion,
    detect_contacts,
    foot_points,
    forward_kinematics,
    t_pose_alignment,
)
from ..motion.humanoid import FORWARD, UP
from ..rotations import inverse, rotate
from .body import Capsule, PhysicsBody

Array = NDArray[np.float64]
LONG = 0.5
"""Seconds in which a foot stands that is on the ground, and not in the middle of a leap."""
STANDING = 25.0
"""Percentile of the heights of a foot in contact at which it stands flat."""

ANKLE, BALL = (0.075, 0.03, 0.14), (0.02, 0.008, 0.05)
"""Height over the sole of a standing foot's joints, for legs of 0.9 m: usual, least, most."""

HEEL_BEHIND = 0.04
FOOT_LENGTH, TOE_LENGTH = 0.14, 0.05
HEEL_HALF_WIDTH, BALL_HALF_WIDTH = 0.015, 0.03
HEEL_RADIUS, BALL_RADIUS, TOE_RADIUS = 0.03, 0.02, 0.012
"""Metres, for legs of 0.9 m."""


def has_feet(humanoid: HumanoidMap) -> bool:
    """Whether both feet are known."""
    return humanoid.has("leftFoot", "rightFoot")


def find_ground(motion: Motion, humanoid: HumanoidMap, size: float) -> float:
    """Return the height in metres at which the take's lower foot stands; of its lowest joint
    where it has no feet.
    """
    positions = forward_kinematics(motion).positions
    if not has_feet(humanoid):
        return float(positions[..., 2].min())
    contacts = detect_contacts(motion, humanoid)
    heights = []
    for side, (ankle, toe) in enumerate(foot_points(motion.skeleton, humanoid)):
        usual = (ANKLE if toe == ankle else BALL)[0] * size
        heights.append(_standing(positions[:, toe, 2], contacts[:, side]) - usual)
    return min(heights)


def stands_for_long(motion: Motion, humanoid: HumanoidMap) -> bool:
    """Whether a foot of the take stands, now and then, for half a second in all."""
    if not has_feet(humanoid):
        return False
    stands = detect_contacts(motion, humanoid).any(axis=1)
    return bool(stands.sum() * motion.dt >= LONG)


def add_soles(
    body: PhysicsBody, motion: Motion, humanoid: HumanoidMap, ground: float
) -> PhysicsBody:
    """Return the body with heels, balls and toes that touch the ground where the take stands.

    The skin of a foot cannot be told from its joints. How high ankle and ball are over the
    sole, and which way is up for a flat foot, is taken from the frames in which it stands on
    the ground; where the take does not tell, or is not near the ground, from the usual foot and
    the rest pose.
    """
    if not has_feet(humanoid) or not body.roles:
        return body
    alignment = t_pose_alignment(body.skeleton, humanoid)
    poses = forward_kinematics(motion)
    contacts = detect_contacts(motion, humanoid)
    soles, bare = [], set()
    for side, (ankle, toe) in enumerate(foot_points(body.skeleton, humanoid)):
        heights = poses.positions[:, [ankle, toe], 2] - ground
        standing = contacts[:, side]
        flat = standing & (heights <= _median(heights, standing)).all(axis=1)
        clear = [
            _clearance(heights[:, column], standing, range_, body.size)
            for column, range_ in ((0, ANKLE), (1, BALL))
        ]
        ups = {
            joint: _up(poses.rotations[flat, joint], rotate(alignment[joint], UP))
            for joint in (ankle, toe)
        }
        forward = rotate(alignment[ankle], FORWARD)
        soles += _sole(body, int(ankle), int(toe), clear, ups, forward)
        bare |= {int(ankle), int(toe)}
    skins = [
        replace(capsule, touches=False) if capsule.joint in bare else capsule
        for capsule in body.capsules
    ]
    return replace(body, capsules=(*skins, *soles))


def _sole(
    body: PhysicsBody,
    ankle: int,
    toe: int,
    clear: list[float],
    ups: dict[int, Array],
    forward: Array,
) -> list[Capsule]:
    """Return skins across heel, ball and tip of the toes, all down to one level."""
    size, up = body.size, ups[ankle]
    ball = body.skeleton.offsets[toe] if toe != ankle else FOOT_LENGTH * size * forward
    way = _level(ball, up, forward)
    ball_clear = clear[1] if toe != ankle else clear[0]
    heel = -HEEL_BEHIND * size * way
    lowered = ball - (ball @ up) * up - clear[0] * up if toe == ankle else ball - clear[1] * up
    capsules = [
        _across(ankle, heel - clear[0] * up, up, way, HEEL_HALF_WIDTH * size,
                min(HEEL_RADIUS * size, 0.9 * clear[0])),
        _across(ankle, lowered, up, way, BALL_HALF_WIDTH * size,
                min(BALL_RADIUS * size, ball_clear)),
    ]  # fmt: skip
    if toe != ankle and toe in body.joints:
        up = ups[toe]
        ends = [body.skeleton.offsets[child] for child in body.skeleton.children[toe]]
        way = _level(ends[0] if ends else forward, up, forward)
        tip = TOE_LENGTH * size * way - clear[1] * up
        radius = min(TOE_RADIUS * size, clear[1])
        capsules.append(_across(toe, tip, up, way, BALL_HALF_WIDTH * size, radius))
    return capsules


def _across(
    joint: int, bottom: Array, up: Array, way: Array, half_width: float, radius: float
) -> Capsule:
    """Return a skin across the foot whose lowest point is at `bottom`."""
    aside = half_width * np.cross(up, way)
    middle = bottom + radius * up
    return Capsule(joint, np.stack([middle - aside, middle + aside]), radius, 0.0)


def _level(way: Array, up: Array, otherwise: Array) -> Array:
    """Return the part of a way that is level on a sole, of length 1."""
    for candidate in (way, otherwise, np.array([1.0, 0.0, 0.0])):
        level = candidate - (candidate @ up) * up
        if (length := np.linalg.norm(level)) > 1e-3:
            return np.asarray(level / length)
    return otherwise


def _up(rotations: Array, usual: Array) -> Array:
    """Return which way is up for a foot that stands flat, in its own frame."""
    if not len(rotations):
        return usual
    up = rotate(inverse(rotations), UP).mean(axis=0)
    length = float(np.linalg.norm(up))
    return np.asarray(up / length) if length > 0.5 else usual


def _clearance(
    heights: Array, standing: NDArray[np.bool_], limits: tuple[float, ...], size: float
) -> float:
    """Return how high a joint is over the sole, as seen if that is plausible."""
    usual, least, most = (size * limit for limit in limits)
    if not standing.any():
        return usual
    seen = float(np.percentile(heights[standing], STANDING))
    return seen if least <= seen <= most else usual


def _standing(heights: Array, standing: NDArray[np.bool_]) -> float:
    chosen = heights[standing]
    return float(np.percentile(chosen, STANDING)) if len(chosen) else float(heights.min())


def _median(heights: Array, standing: NDArray[np.bool_]) -> Array:
    """Return the height of each joint below which a standing foot is flat."""
    chosen = heights[standing]
    return np.asarray(np.median(chosen, axis=0) if len(chosen) else heights.min(axis=0))
