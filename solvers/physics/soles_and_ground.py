"""Add soles to the feet of a simulated body, and find the ground, from the take itself."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
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

MIN_CONTACT_S = 0.5
"""Minimum total contact in seconds of a take that stands on the ground. It guards takes of a
leap or a dive, whose lowest feet are not on it
(`test_brief_contact_does_not_show_the_ground`)."""
STANCE_PERCENTILE = 25.0
"""Percentile of the heights of a foot in contact at which it stands flat. Half and twice gain
less than 1 % (`make sensitivity`)."""

ANKLE_HEIGHTS_M, BALL_HEIGHTS_M = (0.075, 0.03, 0.14), (0.02, 0.008, 0.05)
"""Height of a standing foot's joints above the sole, for legs of 0.9 m: default, minimum,
maximum. Chosen by hand; `make sensitivity` varies them."""

HEEL_OFFSET_M = 0.04
"""Chosen by hand; `make sensitivity` varies it."""
FOOT_LENGTH_M = 0.14
"""Meters, for legs of 0.9 m, of feet without a toe joint. It guards rigs whose feet end at the
ankle (`test_feet_without_toes_reach_ahead_of_their_ankles`)."""
TOE_LENGTH_M = 0.05
"""Meters, for legs of 0.9 m, of toes. Chosen by hand; `make sensitivity` varies it."""
HEEL_HALF_WIDTH_M, BALL_HALF_WIDTH_M = 0.015, 0.03
"""Chosen by hand; `make sensitivity` varies them."""
HEEL_RADIUS_M, BALL_RADIUS_M, TOE_RADIUS_M = 0.03, 0.02, 0.012
"""Meters, for legs of 0.9 m. Half and twice gain less than 1 % (`make sensitivity`)."""


def has_feet(humanoid: HumanoidMap) -> bool:
    """Return whether both feet are known."""
    return humanoid.has("leftFoot", "rightFoot")


def find_ground(motion: Motion, humanoid: HumanoidMap, size: float) -> float:
    """Return the height in meters at which the take's lower foot stands, or of its lowest joint
    without feet."""
    positions = forward_kinematics(motion).positions
    if not has_feet(humanoid):
        return float(positions[..., 2].min())
    contacts = detect_contacts(motion, humanoid)
    heights = []
    for side, (ankle, toe) in enumerate(foot_points(motion.skeleton, humanoid)):
        default = (ANKLE_HEIGHTS_M if toe == ankle else BALL_HEIGHTS_M)[0] * size
        heights.append(_stance_height(positions[:, toe, 2], contacts[:, side]) - default)
    return min(heights)


def has_long_contact(motion: Motion, humanoid: HumanoidMap) -> bool:
    """Return whether the feet of the take are in contact for half a second in total."""
    if not has_feet(humanoid):
        return False
    in_contact = detect_contacts(motion, humanoid).any(axis=1)
    return bool(in_contact.sum() * motion.dt >= MIN_CONTACT_S)


def add_soles(
    body: PhysicsBody, motion: Motion, humanoid: HumanoidMap, ground: float
) -> PhysicsBody:
    """Return the body with heels, balls and toes that touch the ground where the take stands.

    Joints do not determine the surface of a foot. The heights of ankle and ball above the sole,
    and the up direction of a flat foot, come from the frames in which it stands. Without such
    frames, or far from the ground, they come from a default foot and the rest pose.
    """
    if not has_feet(humanoid) or not body.roles:
        return body
    alignment = t_pose_alignment(body.skeleton, humanoid)
    poses = forward_kinematics(motion)
    contacts = detect_contacts(motion, humanoid)
    soles, replaced_joints = [], set()
    for side, (ankle, toe) in enumerate(foot_points(body.skeleton, humanoid)):
        heights = poses.positions[:, [ankle, toe], 2] - ground
        in_contact = contacts[:, side]
        flat = in_contact & (heights <= _median_heights(heights, in_contact)).all(axis=1)
        clearances = [
            _height_above_sole(heights[:, column], in_contact, range_, body.size)
            for column, range_ in ((0, ANKLE_HEIGHTS_M), (1, BALL_HEIGHTS_M))
        ]
        ups = {
            joint: _up_direction(poses.rotations[flat, joint], rotate(alignment[joint], UP))
            for joint in (ankle, toe)
        }
        forward = rotate(alignment[ankle], FORWARD)
        soles += _build_sole(body, int(ankle), int(toe), clearances, ups, forward)
        replaced_joints |= {int(ankle), int(toe)}
    capsules_without_contact = [
        replace(capsule, touches=False) if capsule.joint in replaced_joints else capsule
        for capsule in body.capsules
    ]
    return replace(body, capsules=(*capsules_without_contact, *soles))


def _build_sole(
    body: PhysicsBody,
    ankle: int,
    toe: int,
    clearances: list[float],
    ups: dict[int, Array],
    forward: Array,
) -> list[Capsule]:
    """Return capsules across heel, ball and tip of the toes, with their bottoms at one
    level."""
    size, up = body.size, ups[ankle]
    ball = body.skeleton.offsets[toe] if toe != ankle else FOOT_LENGTH_M * size * forward
    direction = _horizontal_direction(ball, up, forward)
    ball_clear = clearances[1] if toe != ankle else clearances[0]
    heel = -HEEL_OFFSET_M * size * direction
    lowered = (
        ball - (ball @ up) * up - clearances[0] * up
        if toe == ankle
        else ball - clearances[1] * up
    )
    capsules = [
        _transverse_capsule(
                ankle, heel - clearances[0] * up, up, direction, HEEL_HALF_WIDTH_M * size,
                min(HEEL_RADIUS_M * size, 0.9 * clearances[0])),
        _transverse_capsule(ankle, lowered, up, direction, BALL_HALF_WIDTH_M * size,
                min(BALL_RADIUS_M * size, ball_clear)),
    ]  # fmt: skip
    if toe != ankle and toe in body.joints:
        up = ups[toe]
        ends = [body.skeleton.offsets[child] for child in body.skeleton.children[toe]]
        direction = _horizontal_direction(ends[0] if ends else forward, up, forward)
        tip = TOE_LENGTH_M * size * direction - clearances[1] * up
        radius = min(TOE_RADIUS_M * size, clearances[1])
        capsules.append(
            _transverse_capsule(toe, tip, up, direction, BALL_HALF_WIDTH_M * size, radius)
        )
    return capsules


def _transverse_capsule(
    joint: int, bottom: Array, up: Array, direction: Array, half_width: float, radius: float
) -> Capsule:
    """Return a capsule across the foot with its lowest point at `bottom`."""
    half_axis = half_width * np.cross(up, direction)
    middle = bottom + radius * up
    return Capsule(joint, np.stack([middle - half_axis, middle + half_axis]), radius, 0.0)


def _horizontal_direction(direction: Array, up: Array, fallback: Array) -> Array:
    """Return the component of a direction along the sole, of length 1."""
    for candidate in (direction, fallback, np.array([1.0, 0.0, 0.0])):
        level = candidate - (candidate @ up) * up
        if (length := np.linalg.norm(level)) > 1e-3:
            return np.asarray(level / length)
    return fallback


def _up_direction(rotations: Array, default: Array) -> Array:
    """Return the up direction of a flat foot, in its own frame."""
    if not len(rotations):
        return default
    up = rotate(inverse(rotations), UP).mean(axis=0)
    length = float(np.linalg.norm(up))
    return np.asarray(up / length) if length > 0.5 else default


def _height_above_sole(
    heights: Array, in_contact: NDArray[np.bool_], limits: tuple[float, ...], size: float
) -> float:
    """Return the height of a joint above the sole, as measured if that is plausible."""
    default, lower, upper = (size * limit for limit in limits)
    if not in_contact.any():
        return default
    measured = float(np.percentile(heights[in_contact], STANCE_PERCENTILE))
    return measured if lower <= measured <= upper else default


def _stance_height(heights: Array, in_contact: NDArray[np.bool_]) -> float:
    stance_heights = heights[in_contact]
    return (
        float(np.percentile(stance_heights, STANCE_PERCENTILE))
        if len(stance_heights)
        else float(heights.min())
    )


def _median_heights(heights: Array, in_contact: NDArray[np.bool_]) -> Array:
    """Return the height of each joint below which a standing foot is flat."""
    stance_heights = heights[in_contact]
    return np.asarray(
        np.median(stance_heights, axis=0) if len(stance_heights) else heights.min(axis=0)
    )
