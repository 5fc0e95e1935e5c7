"""Measures of a retargeted body: the solver's own targets, and poses in the world.

IK: distance of foot and hand from where the solver wanted them, so that it shows only whether
the limbs reached. Everything else is measured in the world, against the source scaled by the
legs from the ground under its first position; arms, trunk and legs of other proportions cannot
all be there at once, so that no method gets 0. A path is what is left without the mean of the
clip, which is the difference of the proportions.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    WorldPoses,
    detect_contacts,
    foot_points,
    forward_kinematics,
    leg_length,
)
from solvers.motion.humanoid import SIDES
from solvers.rotations.representations import inverse, rotate, rotation_between

MIN_SUNK_DEPTH_M = 0.01
"""Meters below its height in the rest pose at which the ball of a foot has sunk."""
FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")


@dataclass(frozen=True, eq=False)
class Acted:
    """A motion, its roles, and where its joints are in the world."""

    motion: Motion
    humanoid: HumanoidMap
    joints: dict[str, int]
    poses: WorldPoses

    def at(self, role: str) -> Array:
        """Return where the joint with this role is, shape (n_frames, 3), meters."""
        return np.asarray(self.poses.positions[:, self.joints[role]])

    def on_ground(self, role: str) -> Array:
        """Return the same from the ground under the first position of the hips."""
        return self.at(role) - self.at("hips")[0] * (1.0, 1.0, 0.0)


def acted(motion: Motion, humanoid: HumanoidMap) -> Acted:
    """Return the motion with what is measured of it."""
    joints = humanoid.indices(motion.skeleton)
    return Acted(motion, humanoid, joints, forward_kinematics(motion))


def ik_figures(source: Acted, given: Acted) -> dict[str, float]:
    """Return how far limbs are from where the solver wanted them, and how feet slide."""
    growth = _growth(source, given)
    feet, hands = [], []
    for side in SIDES:
        a, b = source.at(f"{side}Foot"), given.at(f"{side}Foot")
        feet.append((b - b[0]) - growth * (a - a[0]))
        a, b = (one.at(f"{side}Hand") - one.at(f"{side}UpperArm") for one in (source, given))
        arm = _arm(given, side) / _arm(source, side)
        hands.append(b - arm * a)
    foot, hand = (100.0 * np.linalg.norm(each, axis=-1) for each in (feet, hands))
    contacts = detect_contacts(source.motion, source.humanoid)
    slides = [100.0 * _slide(one, contacts) for one in (source, given)]
    return {
        "IK: foot cm": foot.mean(), "at most": foot.max(),
        "IK: hand cm": hand.mean(), "hand at most": hand.max(),
        "slide of source cm/s": growth * slides[0], "slide cm/s": slides[1],
    }  # fmt: skip


def world_figures(source: Acted, given: Acted) -> dict[str, float]:
    """Return how far the body is, in the world, from the source scaled by the legs."""
    growth = _growth(source, given)
    hands, paths = zip(
        *(_off(source, given, f"{side}Hand", growth) for side in SIDES), strict=True
    )
    head, head_path = _off(source, given, "head", growth)
    trunk = trunk_angles(source, given)
    lowest = [100.0 * _lowest(one) for one in (source, given)]
    below = np.minimum(0.0, growth * lowest[0]) - lowest[1]
    return {
        "hand cm": float(np.mean(hands)),
        "its path": float(np.mean(paths)), "path at most": float(np.max(paths)),
        "head cm": head.mean(), "head path at most": head_path.max(),
        "trunk degrees": trunk.mean(), "trunk at most": trunk.max(),
        "below floor cm": max(0.0, float(below.max())),
        "sunk feet %": 100.0 * float(np.mean(_sinking(given) > MIN_SUNK_DEPTH_M)),
        "knee acceleration": _shake(source, given, "LowerLeg", growth),
        "elbow acceleration": _shake(source, given, "LowerArm", growth),
    }  # fmt: skip


def trunk_angles(source: Acted, given: Acted) -> Array:
    """Return the angle between the directions from hips to neck, less that at rest, degrees.

    The source's direction is first rotated with its hips, since rest poses differ.
    """
    directions, rests = [], []
    for one in (source, given):
        top, hips = one.joints["neck"], one.joints["hips"]
        positions = one.motion.skeleton.rest_positions
        rests.append(_unit(positions[top] - positions[hips]))
        directions.append(_unit(one.at("neck") - one.at("hips")))
    rotation = source.poses.rotations[:, source.joints["hips"]]
    in_hips = rotate(rotation_between(*rests), rotate(inverse(rotation), directions[0]))
    cosines = (rotate(rotation, in_hips) * directions[1]).sum(axis=-1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))


def _sinking(given: Acted) -> Array:
    """Return how far the ball of each foot is below its height at rest, worst frame, meters.

    Of rigs whose rest pose stands on height 0.
    """
    balls = foot_points(given.motion.skeleton, given.humanoid)[:, 1]
    rest = given.motion.skeleton.rest_positions[balls, 2]
    return np.asarray((rest - given.poses.positions[:, balls, 2]).max(axis=0))


def _off(source: Acted, given: Acted, role: str, growth: float) -> tuple[Array, Array]:
    """Return how far a joint is from the source's, grown with the legs, centimeters.

    And how far it is without the mean of the clip, both of shape (n_frames,).
    """
    offset = 100.0 * (given.on_ground(role) - growth * source.on_ground(role))
    about_mean = offset - offset.mean(axis=0)
    return np.linalg.norm(offset, axis=-1), np.linalg.norm(about_mean, axis=-1)


def _lowest(one: Acted) -> Array:
    """Return the height of the lowest joint with a role but fingers, (n_frames,), meters."""
    body = [joint for role, joint in one.joints.items() if not any(f in role for f in FINGERS)]
    return np.asarray(one.poses.positions[:, body, 2].min(axis=1))


def _shake(source: Acted, given: Acted, part: str, growth: float) -> float:
    """Return the greatest acceleration of knee or elbow, times the source's, grown."""
    return max(
        _acceleration(given, f"{side}{part}")
        / (growth * _acceleration(source, f"{side}{part}"))
        for side in SIDES
    )


def _acceleration(one: Acted, role: str) -> float:
    return float(np.linalg.norm(np.diff(one.at(role), 2, axis=0), axis=-1).max())


def _growth(source: Acted, given: Acted) -> float:
    theirs, ours = (leg_length(one.motion.skeleton, one.humanoid) for one in (source, given))
    return ours / theirs


def _arm(one: Acted, side: str) -> float:
    positions = one.motion.skeleton.rest_positions
    roles = [f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"]
    bones = np.diff(positions[[one.joints[role] for role in roles]], axis=0)
    return float(np.linalg.norm(bones, axis=1).sum())


def _slide(one: Acted, contacts: NDArray[np.bool_]) -> float:
    """Meters per second in contact, of the slower of ankle and toes."""
    skeleton: Skeleton = one.motion.skeleton
    feet = one.poses.positions[:, foot_points(skeleton, one.humanoid), :2]
    steps = np.linalg.norm(np.diff(feet, axis=0), axis=-1).min(axis=-1)
    standing = contacts[1:] & contacts[:-1]
    if not standing.any():
        return float("nan")
    return float(steps[standing].mean()) * one.motion.frame_rate


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))
