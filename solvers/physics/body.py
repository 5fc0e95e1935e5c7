"""Build a body of capsules with the masses and strengths of a human from a skeleton."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import HumanoidMap, Motion, Skeleton, leg_length, t_pose_alignment
from ..motion.humanoid import HUMAN_LEG_LENGTH_M, SIDES
from ..motion.skeletons import still_joints
from ..rotations import IDENTITY, multiply, rotate
from .tables import (
    DEFAULT_STRENGTH_NM,
    DENSITY_KG_M3,
    HUMAN_MASS_KG,
    MASS_FRACTIONS,
    MAX_RADIUS_M,
    ROLES,
    SEGMENT_LENGTHS_M,
    STRENGTHS_NM,
    find_mass_role,
    next_roles,
    role_without_side,
)

LEG_ROLES = {side + part for side in SIDES for part in ("UpperLeg", "LowerLeg")}
MIN_MASS_KG = 0.05
"""Mass of a joint without a segment, for legs of 0.9 m. Half and twice gain less than 1 %
(`make sensitivity`)."""

MIN_SIZE, MAX_SIZE = 0.05, 20.0
"""Bounds of the size of a body: leg length relative to 0.9 m, from a doll to a giant. They
guard takes in a wrong unit (`test_simulate_raises_for_a_wrong_unit`)."""

MIN_FRAME_RATE_HZ = 5.0
"""Minimum frame rate. It guards takes with a few poses a second, between which no path is known
(`test_simulate_raises_for_a_low_frame_rate`)."""

MAX_JOINTS = 250
"""Maximum number of simulated joints. It bounds the run time, which grows with their cube:
the engine needs 0.2 s to build a chain of 125, 1.7 s for one of 250."""

MIN_LENGTH_M = 0.01
"""Meters, for legs of 0.9 m: a shorter segment is a sphere. It guards rigs with bones of zero
length, which have no direction (`test_other_skeleton_is_simulated_bone_by_bone`)."""

LEAF_LENGTH_M = 0.1
"""Meters, for legs of 0.9 m, that each bone of an unknown skeleton counts more in the division
of the mass. It guards joints without children, which would have no mass
(`test_other_skeleton_is_simulated_bone_by_bone`)."""

END_LENGTH_M = 0.1
"""Length of a segment with neither a joint below nor a row of `SEGMENT_LENGTHS_M`, meters, for
legs of 0.9 m. By definition about that of a toe or a finger."""

MASSLESS_RADIUS_M = 0.02
"""Radius of a joint without a segment, meters, for legs of 0.9 m. By definition that of a
finger: it touches nothing."""


class JointFrame(NamedTuple):
    """Position and rotation of a joint relative to the moving joint above it."""

    above: int
    position: Array
    rotation: Array


@dataclass(frozen=True, eq=False)
class Capsule:
    """A capsule fixed to a joint.

    Attributes
    ----------
    joint : int
    ends : float array, shape (2, 3), meters, in the joint's own frame
    radius : float, meters
    mass : float, kilograms; 0 for a capsule that only collides
    touches : bool
        Whether it collides with the ground.
    """

    joint: int
    ends: Array
    radius: float
    mass: float
    touches: bool = True


@dataclass(frozen=True, eq=False)
class PhysicsBody:
    """The simulated part of a skeleton.

    Attributes
    ----------
    skeleton : Skeleton
    joints : tuple of int
        Moving joints, each branch contiguous; the first is the base, which moves freely, and
        the others are ball joints.
    frames : mapping of joint to JointFrame
        Relative to the moving joint above; joints between two moving ones are held rigid.
    roles : mapping of joint to humanoid role
    capsules : tuple of Capsule
    size : float
        Length of a leg over 0.9 m.
    mass : float, kilograms
    strengths : float array, shape (n_joints moving - 1,), newton meters
    """

    skeleton: Skeleton
    joints: tuple[int, ...]
    frames: Mapping[int, JointFrame]
    roles: Mapping[int, str]
    capsules: tuple[Capsule, ...]
    size: float
    mass: float
    strengths: Array

    @property
    def ground_capsules(self) -> tuple[Capsule, ...]:
        """Capsules that collide with the ground; their ends, two of each, are in this order."""
        return tuple(capsule for capsule in self.capsules if capsule.touches)


def build_physics_body(motion: Motion, humanoid: HumanoidMap) -> PhysicsBody:
    """Build the simulated body of a motion without gaps.

    Each joint of a role of `ROLES` starts a segment. Joints between two of them move too if
    they do in the take; others, such as fingers, keep their rotations and have no mass. A
    skeleton without legs is not human: each bone is a segment, with mass proportional to its
    length.
    """
    skeleton = motion.skeleton
    joints = {role: j for role, j in humanoid.indices(skeleton).items() if role in ROLES}
    if not set(joints) >= LEG_ROLES:
        return _body_from_bones(motion)
    size = leg_length(skeleton, humanoid) / HUMAN_LEG_LENGTH_M
    moving, frames = _find_moving_joints(motion, set(joints.values()))
    roles = {joint: role for role, joint in joints.items()}
    masses = dict.fromkeys(moving, 0.0)
    for role in ROLES:
        bearer = joints.get(find_mass_role(role, joints), moving[0])
        masses[bearer] += HUMAN_MASS_KG * size**3 * MASS_FRACTIONS[role_without_side(role)]
    up = rotate(t_pose_alignment(skeleton, humanoid), np.array([0.0, 0.0, 1.0]))
    capsules = []
    for joint in moving:
        end = _segment_end(skeleton, joint, roles.get(joint, ""), joints, size, up[joint])
        capsules.append(_capsule(joint, end, masses[joint], size))
    return _assemble_body(skeleton, moving, frames, roles, capsules, size)


def check_size(body: PhysicsBody, frame_rate: float) -> None:
    """Raise if the size or the frame rate is not plausible for a simulation.

    Raises
    ------
    InvalidMotionError
        The body is implausibly large or small, has too many joints, or the frame rate is too
        low.
    """
    if len(body.joints) > MAX_JOINTS:
        raise InvalidMotionError(
            f"Physics simulates {MAX_JOINTS} bones at most, and {len(body.joints)} of this"
            " armature move. Choose the joints of a body in the humanoid map."
        )
    leg = HUMAN_LEG_LENGTH_M * body.size
    if not MIN_SIZE <= body.size <= MAX_SIZE:
        raise InvalidMotionError(
            f"A leg of {leg:.3g} m is not plausible; set the scale of the recording."
        )
    if frame_rate < MIN_FRAME_RATE_HZ:
        raise InvalidMotionError(
            f"At {frame_rate:g} frames a second the movement between frames is unknown;"
            f" physics needs at least {MIN_FRAME_RATE_HZ:g}."
        )


def _body_from_bones(motion: Motion) -> PhysicsBody:
    """Build a body of any skeleton: bones as long as they are, with a human's density."""
    skeleton = motion.skeleton
    moving, frames = _find_moving_joints(
        motion, {j for j in range(skeleton.n_joints) if skeleton.children[j]}
    )
    ends = [
        skeleton.offsets[list(skeleton.children[joint])].mean(axis=0)
        if skeleton.children[joint]
        else np.zeros(3)
        for joint in moving
    ]
    extent = np.ptp(skeleton.rest_positions, axis=0).max() if skeleton.n_joints > 1 else 0.0
    size = float(extent) / (2 * HUMAN_LEG_LENGTH_M) or 1.0
    lengths = np.linalg.norm(ends, axis=1) + LEAF_LENGTH_M * size
    masses = HUMAN_MASS_KG * size**3 * lengths / lengths.sum()
    capsules = [
        _capsule(joint, end, mass, size)
        for joint, end, mass in zip(moving, ends, masses, strict=True)
    ]
    return _assemble_body(skeleton, moving, frames, {}, capsules, size)


def _assemble_body(
    skeleton: Skeleton,
    moving: tuple[int, ...],
    frames: Mapping[int, JointFrame],
    roles: Mapping[int, str],
    capsules: list[Capsule],
    size: float,
) -> PhysicsBody:
    strengths = [
        STRENGTHS_NM.get(role_without_side(roles.get(joint, "")), DEFAULT_STRENGTH_NM) * size**4
        for joint in moving[1:]
    ]
    mass = sum(capsule.mass for capsule in capsules)
    return PhysicsBody(
        skeleton, moving, frames, roles, tuple(capsules), size, mass, np.array(strengths)
    )


def _find_moving_joints(
    motion: Motion, joints: set[int]
) -> tuple[tuple[int, ...], dict[int, JointFrame]]:
    """Return the joints to simulate, base first and each branch contiguous, and their frames.

    These are the given joints, the lowest joint above them all, and those between that move.
    """
    skeleton = motion.skeleton
    joints = joints or {0}
    chains = [{joint, *skeleton.ancestors(joint)} for joint in joints]
    base = max(set.intersection(*chains))
    candidates = {joint for chain in chains for joint in chain if joint > base}
    is_still = still_joints(motion)
    order, frames, stack = [], {}, [(base, JointFrame(-1, np.zeros(3), IDENTITY))]
    while stack:
        joint, frame = stack.pop()
        first_rotation = motion.rotations[0, joint]
        if joint not in joints and joint != base and is_still[joint]:
            position, rotation = frame.position, multiply(frame.rotation, first_rotation)
            above = frame.above
        else:
            order.append(joint)
            frames[joint] = frame
            above, position, rotation = joint, np.zeros(3), IDENTITY
        stack += [
            (
                child,
                JointFrame(
                    above, position + rotate(rotation, skeleton.offsets[child]), rotation
                ),
            )
            for child in reversed(skeleton.children[joint])
            if child in candidates
        ]
    return tuple(order), frames


def _segment_end(
    skeleton: Skeleton, joint: int, role: str, joints: Mapping[str, int], size: float, up: Array
) -> Array:
    """Return the end of a segment in its joint's own frame, shape (3,)."""
    if not role:
        return np.zeros(3)
    start, rest = skeleton.rest_positions[joint], skeleton.rest_positions
    for below in next_roles(role):
        if below in joints:
            return np.asarray(rest[joints[below]] - start)
    length = SEGMENT_LENGTHS_M.get(role_without_side(role), END_LENGTH_M) * size
    children = skeleton.children[joint]
    direction = rest[list(children)].mean(axis=0) - start if children else np.zeros(3)
    if np.linalg.norm(direction) < MIN_LENGTH_M * size:
        direction = up if role in {"head", "neck"} else skeleton.offsets[joint]
    return np.asarray(direction / max(float(np.linalg.norm(direction)), 1e-9) * length)


def _capsule(joint: int, end: Array, mass: float, size: float) -> Capsule:
    """Return a capsule of a human's density along a segment, with inset ends."""
    length = float(np.linalg.norm(end))
    if mass <= 0.0:
        return Capsule(
            joint,
            np.zeros((2, 3)),
            MASSLESS_RADIUS_M * size,
            MIN_MASS_KG * size**3,
            touches=False,
        )
    if length < MIN_LENGTH_M * size:
        radius = (3.0 / 4.0 * mass / (np.pi * DENSITY_KG_M3)) ** (1 / 3)
        return Capsule(joint, np.zeros((2, 3)), min(radius, MAX_RADIUS_M * size), mass)
    radius = (mass / (DENSITY_KG_M3 * np.pi * length)) ** 0.5
    radius = min(radius, MAX_RADIUS_M * size, 0.5 * length)
    inset = 0.5 * radius / length
    return Capsule(joint, np.stack([inset * end, (1 - inset) * end]), radius, mass)
