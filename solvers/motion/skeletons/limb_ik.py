"""Analytic two-bone inverse kinematics of arms and legs."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...rotations import (
    cross,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
)
from ...settings import Settings, setting
from ...signals import smoothstep
from .kinematics import WorldPoses, forward_kinematics
from .motion import Motion
from .skeleton import Skeleton

MIN_PLANE_FLEXION_RAD, RELIABLE_PLANE_FLEXION_RAD = np.radians([5.0, 25.0])
"""Flexions, radians, from which the pose defines the plane of flexion partly and fully."""


@dataclass(frozen=True, kw_only=True)
class ReachSettings(Settings):
    """Settings of the extension of a limb toward a target."""

    softness: float = setting(
        0.01,
        "Fraction of the limb length to ease into full extension; higher avoids popping knees",
        minimum=0.0, maximum=0.5,
    )  # fmt: skip


def reach(
    motion: Motion,
    limb: tuple[int, int, int],
    targets: Array,
    settings: ReachSettings = ReachSettings(),
    *,
    world: WorldPoses | None = None,
) -> Motion:
    """Rotate the upper and lower joint of a limb so that its end reaches the targets.

    The hinge flexes until the distance from the limb's start to its end equals that to the
    target (law of cosines); then the shortest rotation brings the limb onto the target. The
    plane of flexion is that of the pose; a nearly straight limb uses its mean axis of flexion
    in the clip. Joints between the three, such as twist bones, follow. A limb that is too short
    points at the target and eases into full extension: within `softness` of the full length,
    or from the pose's own extension, the distance approaches the full length exponentially.
    Full folding is approached in the same way.

    Parameters
    ----------
    motion : Motion
    limb : upper, lower and end joint
        Indices such as those of hip, knee and ankle, each an ancestor of the next.
    targets : shape (n_frames, 3), meters, world space
        NaN: the pose is unchanged.
    settings : ReachSettings
    world : WorldPoses, optional
        Those of the motion, as far as this limb and what carries it are concerned.

    Returns
    -------
    Motion
        With new rotations of three joints; the end keeps its world rotation. Unchanged, to
        rounding, where the end is already at the target.

    Raises
    ------
    InvalidMotionError
        The three joints are not one chain, or the targets have another shape.
    """
    _check(motion, limb, targets)
    world = forward_kinematics(motion) if world is None else world
    upper, lower, end = limb
    start, hinge, tip = (world.positions[:, joint] for joint in limb)
    axis = rotate(world.rotations[:, upper], bending_axis(motion, limb, world))
    hinge_rotation = _hinge_rotation(
        hinge - start, tip - hinge, targets - start, axis, settings.softness
    )
    moved_tip = hinge + rotate(hinge_rotation, tip - hinge)
    swing = rotation_between(moved_tip - start, targets - start)
    unturned = inverse(multiply(swing, hinge_rotation))
    changes = [(upper, swing), (lower, hinge_rotation), (end, unturned)]
    rotations = motion.rotations.copy()
    no_target = ~np.isfinite(targets).all(axis=-1)
    for joint, rotation in changes:
        rotated = _rotate_local(motion, world, joint, rotation)
        rotations[:, joint] = np.where(no_target[:, None], rotations[:, joint], rotated)
    return motion.with_poses(rotations)


def bending_axis(
    motion: Motion, limb: tuple[int, int, int], world: WorldPoses | None = None
) -> Array:
    """Return the mean axis of flexion of the limb, shape (3,), in rest-pose axes.

    It is fixed in the upper joint, as the axis of a knee is in the thigh. For a limb that never
    flexes it is that of a knee if the limb points down in the rest pose, else of an elbow.
    """
    upper, lower, end = limb
    world = forward_kinematics(motion) if world is None else world
    first = world.positions[:, lower] - world.positions[:, upper]
    second = world.positions[:, end] - world.positions[:, lower]
    flexion = cross(first, second)
    flexion = rotate(inverse(world.rotations[:, upper]), flexion)
    flexion = flexion[np.isfinite(flexion).all(axis=-1)].sum(axis=0)
    bones = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    if np.linalg.norm(flexion) > 1e-3 * np.nansum(bones):
        return np.asarray(flexion / np.linalg.norm(flexion))
    rest = motion.skeleton.rest_positions
    bone = rest[lower] - rest[upper]
    points_down = -bone[2] > np.abs(bone[:2]).max()
    fallback = cross(bone, np.array([0.0, 1.0 if points_down else -1.0, 0.0]))
    length = np.linalg.norm(fallback)
    return np.asarray(fallback / length) if length > 0.0 else np.array([1.0, 0.0, 0.0])


def _hinge_rotation(
    first: Array, second: Array, target: Array, axis: Array, softness: float
) -> Array:
    """Return the world rotations, (n_frames, 4), of the lower bone that set the limb's length.

    `first` and `second` are the bones, `wanted` is the vector from the limb's start to the
    target.
    """
    a, b = np.linalg.norm(first, axis=-1), np.linalg.norm(second, axis=-1)
    current = np.linalg.norm(first + second, axis=-1)
    distance = _limit_extension(np.linalg.norm(target, axis=-1), current, a + b, softness)
    distance = _limit_folding(distance, current, np.abs(a - b), softness * (a + b))
    cosine = (distance**2 - a**2 - b**2) / np.maximum(2 * a * b, 1e-12)
    after = np.arccos(
        np.clip(cosine, -1.0, 1.0)
    )  # a target that is too near folds the limb fully

    along = first / np.maximum(a, 1e-12)[:, None]
    normal = cross(along, second / np.maximum(b, 1e-12)[:, None])
    sine = np.linalg.norm(normal, axis=-1)
    before = np.arctan2(sine, np.einsum("fi,fi->f", first, second) / np.maximum(a * b, 1e-12))
    level = axis - np.einsum("fi,fi->f", axis, along)[:, None] * along
    level /= np.maximum(np.linalg.norm(level, axis=-1), 1e-12)[:, None]
    normal = np.where(sine[:, None] > 1e-9, normal / np.maximum(sine, 1e-9)[:, None], level)

    # The plane of flexion is rotated by `aside` from the mean one. A nearly straight limb that
    # must flex much more rotates into the mean plane.
    roll_angle = np.arctan2(
        np.einsum("fi,fi->f", cross(level, normal), along),
        np.einsum("fi,fi->f", level, normal),
    )
    reliability = smoothstep(before, MIN_PLANE_FLEXION_RAD, RELIABLE_PLANE_FLEXION_RAD)
    fraction = np.minimum(before / np.maximum(after, 1e-12), 1.0) ** 2
    roll = (reliability + (1.0 - reliability) * fraction) * roll_angle
    new_normal = rotate(quaternion_from_rotation_vector(roll[:, None] * along), level)
    straighten = quaternion_from_rotation_vector(-before[:, None] * normal)
    return multiply(quaternion_from_rotation_vector(after[:, None] * new_normal), straighten)


def _limit_extension(target: Array, current: Array, full: Array, softness: float) -> Array:
    """Return distances of at most `full`; `present` is unchanged."""
    start_distance = np.minimum(np.maximum((1.0 - softness) * full, current), full)
    margin = full - start_distance
    excess = np.maximum(target - start_distance, 0.0)
    approach = margin * -np.expm1(-excess / np.maximum(margin, 1e-12))
    return np.minimum(target, start_distance + approach)


def _limit_folding(target: Array, current: Array, folded: Array, softness: Array) -> Array:
    """Return distances of at least that of the folded limb; `present` is unchanged."""
    start_distance = np.maximum(np.minimum(folded + softness, current), folded)
    margin = start_distance - folded
    shortfall = np.maximum(start_distance - target, 0.0)
    approach = margin * -np.expm1(-shortfall / np.maximum(margin, 1e-12))
    return np.asarray(np.maximum(target, start_distance - approach))


def _rotate_local(motion: Motion, world: WorldPoses, joint: int, rotation: Array) -> Array:
    """Return the local rotations of a joint with a world rotation added.

    Rotations added to the joints above cancel: each is relative to the original pose.
    """
    parent = motion.skeleton.parents[joint]
    if parent < 0:
        return multiply(rotation, motion.rotations[:, joint])
    parent_rotation = world.rotations[:, parent]
    return multiply(
        multiply(multiply(inverse(parent_rotation), rotation), parent_rotation),
        motion.rotations[:, joint],
    )


def _check(motion: Motion, limb: tuple[int, int, int], targets: Array) -> None:
    upper, lower, end = limb
    skeleton: Skeleton = motion.skeleton
    if upper not in skeleton.ancestors(lower) or lower not in skeleton.ancestors(end):
        names = ", ".join(skeleton.names[joint] for joint in limb)
        raise InvalidMotionError(
            f"The three joints of a limb must be one chain; {names} are not."
        )
    if np.shape(targets) != (motion.n_frames, 3):
        raise InvalidMotionError(
            f"Targets need shape ({motion.n_frames}, 3), not {np.shape(targets)}."
        )
