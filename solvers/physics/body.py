"""A skeleton as a body of capsules with the masses and the strength of a human."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import HumanoidMap, Motion, Skeleton, leg_length, t_pose_alignment
from ..motion.humanoid import HUMAN_LEG
from ..rotations import IDENTITY, angle_between, multiply, rotate
from .tables import (
    DENSITY,
    HUMAN_MASS,
    LENGTHS,
    MASS_SHARES,
    OTHER_STRENGTH,
    ROLES,
    STRENGTHS,
    THICKEST,
    bearer,
    next_roles,
    part_of,
)

Array = NDArray[np.float64]
LEGS = {side + part for side in ("left", "right") for part in ("UpperLeg", "LowerLeg")}
LIGHTEST = 0.05
"""Kilograms of a joint that is no segment, for legs of 0.9 m."""

STILL = 1e-3
"""Radians: a joint that turns less, and plays no role, is part of the one above."""

SMALLEST, LARGEST = 0.05, 20.0
"""Of a body, as a length of leg over 0.9 m."""

SLOWEST = 5.0
"""Hertz."""

SHORT = 0.01
"""Metres, for legs of 0.9 m: a shorter segment is a ball."""


class Frame(NamedTuple):
    """Where a joint sits on the moving joint above it."""

    above: int
    place: Array
    rotation: Array


@dataclass(frozen=True, eq=False)
class Capsule:
    """A line with a skin, fixed to a joint.

    Attributes
    ----------
    joint : int
    ends : float array, shape (2, 3), metres, in the joint's own frame
    radius : float, metres
    mass : float, kilograms; 0 for a mere skin
    touches : bool
        Whether it meets the ground.
    """

    joint: int
    ends: Array
    radius: float
    mass: float
    touches: bool = True


@dataclass(frozen=True, eq=False)
class PhysicsBody:
    """What is simulated of a skeleton.

    Attributes
    ----------
    skeleton : Skeleton
    joints : tuple of int
        Joints that move, each branch in one piece; the first is the base, which moves freely,
        and the others are ball joints.
    frames : mapping of joint to the moving joint above, its place and its rotation there
        Between two moving joints there may be others, which are held as they are.
    roles : mapping of joint to humanoid role
    capsules : tuple of Capsule
    size : float
        Length of a leg over 0.9 m.
    mass : float, kilograms
    strengths : float array, shape (n_joints moving - 1,), newton metres
    """

    skeleton: Skeleton
    joints: tuple[int, ...]
    frames: Mapping[int, Frame]
    roles: Mapping[int, str]
    capsules: tuple[Capsule, ...]
    size: float
    mass: float
    strengths: Array

    @property
    def grounded(self) -> tuple[Capsule, ...]:
        """Capsules that meet the ground; their ends, two of each, are counted in this order."""
        return tuple(capsule for capsule in self.capsules if capsule.touches)


def build_physics_body(motion: Motion, humanoid: HumanoidMap) -> PhysicsBody:
    """Build the body that is simulated, of a motion without gaps.

    Each joint of a role of `ROLES` begins a segment, and joints between two of them move too if
    they do in the take; others, such as fingers, keep their rotations and weigh nothing. A
    skeleton without legs is no human: there each bone is a segment, by whose length the mass is
    shared.
    """
    skeleton = motion.skeleton
    joints = {role: j for role, j in humanoid.indices(skeleton).items() if role in ROLES}
    if not set(joints) >= LEGS:
        return _some_body(motion)
    size = leg_length(skeleton, humanoid) / HUMAN_LEG
    moving, frames = _moving(motion, set(joints.values()))
    roles = {joint: role for role, joint in joints.items()}
    masses = dict.fromkeys(moving, 0.0)
    for role in ROLES:
        carrier = joints.get(bearer(role, joints), moving[0])
        masses[carrier] += HUMAN_MASS * size**3 * MASS_SHARES[part_of(role)]
    up = rotate(t_pose_alignment(skeleton, humanoid), np.array([0.0, 0.0, 1.0]))
    capsules = []
    for joint in moving:
        end = _segment_end(skeleton, joint, roles.get(joint, ""), joints, size, up[joint])
        capsules.append(_capsule(joint, end, masses[joint], size))
    return _body(skeleton, moving, frames, roles, capsules, size)


def check_size(body: PhysicsBody, frame_rate: float) -> None:
    """Refuse what gravity has no meaning for.

    Raises
    ------
    InvalidMotionError
        The body is a giant or an ant, or so slowly sampled that nothing tells how it moved.
    """
    leg = HUMAN_LEG * body.size
    if not SMALLEST <= body.size <= LARGEST:
        raise InvalidMotionError(
            f"A leg of {leg:.3g} m is no size for physics; give the scale of the recording."
        )
    if frame_rate < SLOWEST:
        raise InvalidMotionError(
            f"At {frame_rate:g} frames a second nothing tells how the body moved in between;"
            f" physics needs at least {SLOWEST:g}."
        )


def _some_body(motion: Motion) -> PhysicsBody:
    """Build a body of any skeleton: bones as long as they are, and as heavy as a human's."""
    skeleton = motion.skeleton
    moving, frames = _moving(
        motion, {j for j in range(skeleton.n_joints) if skeleton.children[j]}
    )
    ends = [
        skeleton.offsets[list(skeleton.children[joint])].mean(axis=0)
        if skeleton.children[joint]
        else np.zeros(3)
        for joint in moving
    ]
    reach = np.ptp(skeleton.rest_positions, axis=0).max() if skeleton.n_joints > 1 else 0.0
    size = float(reach) / (2 * HUMAN_LEG) or 1.0
    lengths = np.linalg.norm(ends, axis=1) + 0.1 * size
    masses = HUMAN_MASS * size**3 * lengths / lengths.sum()
    capsules = [
        _capsule(joint, end, mass, size)
        for joint, end, mass in zip(moving, ends, masses, strict=True)
    ]
    return _body(skeleton, moving, frames, {}, capsules, size)


def _body(
    skeleton: Skeleton,
    moving: tuple[int, ...],
    frames: Mapping[int, Frame],
    roles: Mapping[int, str],
    capsules: list[Capsule],
    size: float,
) -> PhysicsBody:
    strengths = [
        STRENGTHS.get(part_of(roles.get(joint, "")), OTHER_STRENGTH) * size**4
        for joint in moving[1:]
    ]
    mass = sum(capsule.mass for capsule in capsules)
    return PhysicsBody(
        skeleton, moving, frames, roles, tuple(capsules), size, mass, np.array(strengths)
    )


def _moving(motion: Motion, joints: set[int]) -> tuple[tuple[int, ...], dict[int, Frame]]:
    """Return the joints to simulate, base first and each branch in one piece, and their frames.

    These are the given ones, the lowest joint above them all, and those between that move.
    """
    skeleton = motion.skeleton
    joints = joints or {0}
    lines = [{joint, *skeleton.ancestors(joint)} for joint in joints]
    base = max(set.intersection(*lines))
    between = {joint for line in lines for joint in line if joint > base}
    order, frames, waiting = [], {}, [(base, Frame(-1, np.zeros(3), IDENTITY))]
    while waiting:
        joint, frame = waiting.pop()
        held = motion.rotations[0, joint]
        is_still = angle_between(motion.rotations[:, joint], held).max() < STILL
        if joint not in joints and joint != base and is_still:
            place, rotation = frame.place, multiply(frame.rotation, held)
            above = frame.above
        else:
            order.append(joint)
            frames[joint] = frame
            above, place, rotation = joint, np.zeros(3), IDENTITY
        waiting += [
            (child, Frame(above, place + rotate(rotation, skeleton.offsets[child]), rotation))
            for child in reversed(skeleton.children[joint])
            if child in between
        ]
    return tuple(order), frames


def _segment_end(
    skeleton: Skeleton, joint: int, role: str, joints: Mapping[str, int], size: float, up: Array
) -> Array:
    """Return where a segment ends, in its joint's own frame, shape (3,)."""
    if not role:
        return np.zeros(3)
    start, rest = skeleton.rest_positions[joint], skeleton.rest_positions
    for below in next_roles(role):
        if below in joints:
            return np.asarray(rest[joints[below]] - start)
    length = LENGTHS.get(part_of(role), 0.1) * size
    children = skeleton.children[joint]
    way = rest[list(children)].mean(axis=0) - start if children else np.zeros(3)
    if np.linalg.norm(way) < SHORT * size:
        way = up if role in {"head", "neck"} else skeleton.offsets[joint]
    return np.asarray(way / max(float(np.linalg.norm(way)), 1e-9) * length)


def _capsule(joint: int, end: Array, mass: float, size: float) -> Capsule:
    """Return a capsule of a human's density along a segment, drawn in at its ends."""
    length = float(np.linalg.norm(end))
    if mass <= 0.0:
        return Capsule(joint, np.zeros((2, 3)), 0.02 * size, LIGHTEST * size**3, touches=False)
    if length < SHORT * size:
        radius = (0.75 * mass / (np.pi * DENSITY)) ** (1 / 3)
        return Capsule(joint, np.zeros((2, 3)), min(radius, THICKEST * size), mass)
    radius = (mass / (DENSITY * np.pi * length)) ** 0.5
    radius = min(radius, THICKEST * size, 0.5 * length)
    draw_in = 0.5 * radius / length
    return Capsule(joint, np.stack([draw_in * end, (1 - draw_in) * end]), radius, mass)
