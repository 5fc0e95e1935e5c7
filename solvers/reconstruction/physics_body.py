"""A skeleton as a body of capsules with the masses and the strength of a human."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import HumanoidMap, Skeleton, leg_length, t_pose_alignment
from ..motion.contacts import HUMAN_LEG
from ..motion.rotations import rotate
from .physics_tables import (
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

SHORT = 0.01
"""Metres, for legs of 0.9 m: a shorter segment is a ball."""


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
    roles : mapping of joint to humanoid role
    capsules : tuple of Capsule
    size : float
        Length of a leg over 0.9 m.
    mass : float, kilograms
    strengths : float array, shape (n_joints moving - 1,), newton metres
    """

    skeleton: Skeleton
    joints: tuple[int, ...]
    roles: Mapping[int, str]
    capsules: tuple[Capsule, ...]
    size: float
    mass: float
    strengths: Array

    def parent(self, joint: int) -> int:
        """Return the moving joint above; -1 for the base, above which nothing is simulated."""
        return -1 if joint == self.joints[0] else self.skeleton.parents[joint]


def physics_body(skeleton: Skeleton, humanoid: HumanoidMap) -> PhysicsBody:
    """Build the body that is simulated.

    Each joint of a role of `ROLES` begins a segment, and joints between two of them move too;
    others, such as fingers, keep their rotations and weigh nothing. A skeleton without legs is
    no human: there each bone is a segment, by whose length the mass is shared.
    """
    joints = {role: j for role, j in humanoid.indices(skeleton).items() if role in ROLES}
    if not LEGS <= set(joints):
        return _some_body(skeleton)
    size = leg_length(skeleton, humanoid) / HUMAN_LEG
    moving = _moving(skeleton, set(joints.values()))
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
    return _body(skeleton, moving, roles, capsules, size)


def _some_body(skeleton: Skeleton) -> PhysicsBody:
    """Build a body of any skeleton: bones as long as they are, and as heavy as a human's."""
    moving = _moving(skeleton, {j for j in range(skeleton.n_joints) if skeleton.children[j]})
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
    return _body(skeleton, moving, {}, capsules, size)


def _body(
    skeleton: Skeleton,
    moving: tuple[int, ...],
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
        skeleton, moving, roles, tuple(capsules), size, mass, np.array(strengths)
    )


def _moving(skeleton: Skeleton, joints: set[int]) -> tuple[int, ...]:
    """Return these joints and those between them, base first, each branch in one piece."""
    joints = joints or {0}
    lines = [[joint, *skeleton.ancestors(joint)] for joint in joints]
    shared = set(lines[0]).intersection(*lines)
    base = max(shared)
    inside = {joint for line in lines for joint in line if joint >= base} - (shared - {base})
    order, waiting = [], [base]
    while waiting:
        joint = waiting.pop()
        order.append(joint)
        waiting += [child for child in reversed(skeleton.children[joint]) if child in inside]
    return tuple(order)


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
