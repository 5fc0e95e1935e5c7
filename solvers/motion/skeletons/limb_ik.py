"""Bring the end of an arm or a leg to a place by turning its two bones."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
)
from ...settings import Settings, setting
from .kinematics import WorldPoses, forward_kinematics
from .motion import Motion
from .skeleton import Skeleton

DOUBTED_BEND, TRUSTED_BEND = np.radians([5.0, 25.0])
"""Flexions at which the pose itself begins to tell, and fully tells, the plane of bending."""

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ReachSettings(Settings):
    """How a limb stretches."""

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
    keep_orientation: bool = True,
) -> Motion:
    """Turn a limb's upper and lower joint so that its end comes to the targets.

    The hinge bends or opens until the end is as far from the limb's start as the target is
    (law of cosines), then the whole limb turns the short way onto the target. It bends in the
    plane of the pose itself; where that is too straight to tell, about the axis in which the
    limb bends elsewhere in the clip. Joints between the three, such as twist bones, turn along.
    Farther than the limb reaches, it points at the target and eases into full extension: from
    `softness` before it, or from as far as the pose already is, the distance approaches the
    full length exponentially; so it does towards full folding.

    Parameters
    ----------
    motion : Motion
    limb : upper, lower and end joint
        Indices such as those of hip, knee and ankle, each an ancestor of the next.
    targets : shape (n_frames, 3), metres, world space
        NaN leaves the pose as it is.
    settings : ReachSettings
    keep_orientation : bool
        Let the end joint keep its orientation in the world; it keeps its local rotation if not.

    Returns
    -------
    Motion
        Other rotations for two or three joints. Unchanged, to rounding, where the end already
        is at the target.

    Raises
    ------
    InvalidMotionError
        The three joints do not follow one another, or the targets have another shape.
    """
    _check(motion, limb, targets)
    world = forward_kinematics(motion)
    upper, lower, end = limb
    start, hinge, tip = (world.positions[:, joint] for joint in limb)
    axis = rotate(world.rotations[:, upper], bending_axis(motion, limb, world))
    bent = _hinge_turn(hinge - start, tip - hinge, targets - start, axis, settings.softness)
    moved_tip = hinge + rotate(bent, tip - hinge)
    swung = rotation_between(moved_tip - start, targets - start)
    turns = [(upper, swung), (lower, bent)]
    if keep_orientation:
        turns.append((end, inverse(multiply(swung, bent))))
    rotations = motion.rotations.copy()
    idle = ~np.isfinite(targets).all(axis=-1)
    for joint, turn in turns:
        turned = _turned(motion, world, joint, turn)
        rotations[:, joint] = np.where(idle[:, None], rotations[:, joint], turned)
    return motion.with_poses(rotations)


def bending_axis(
    motion: Motion, limb: tuple[int, int, int], world: WorldPoses | None = None
) -> Array:
    """Return the axis about which the limb mostly flexes, shape (3,), in rest-pose axes.

    It is fixed in the upper joint, as a knee's is in the thigh. A limb that never bends bends
    like a knee if it hangs in the rest pose, backwards, and like an elbow if not, forwards.
    """
    upper, lower, end = limb
    world = forward_kinematics(motion) if world is None else world
    first = world.positions[:, lower] - world.positions[:, upper]
    second = world.positions[:, end] - world.positions[:, lower]
    flexion = np.cross(first, second)
    flexion = rotate(inverse(world.rotations[:, upper]), flexion)
    flexion = flexion[np.isfinite(flexion).all(axis=-1)].sum(axis=0)
    bones = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    if np.linalg.norm(flexion) > 1e-3 * np.nansum(bones):
        return np.asarray(flexion / np.linalg.norm(flexion))
    rest = motion.skeleton.rest_positions
    bone = rest[lower] - rest[upper]
    hangs = -bone[2] > np.abs(bone[:2]).max()
    fallback = np.cross(bone, (0.0, 1.0 if hangs else -1.0, 0.0))
    length = np.linalg.norm(fallback)
    return np.asarray(fallback / length) if length > 0.0 else np.array([1.0, 0.0, 0.0])


def _hinge_turn(first: Array, second: Array, wanted: Array, axis: Array, soft: float) -> Array:
    """Return the world turns, (n_frames, 4), of the lower bone that give the limb its reach.

    `first` and `second` are the bones, `wanted` leads from the limb's start to the target.
    """
    a, b = np.linalg.norm(first, axis=-1), np.linalg.norm(second, axis=-1)
    present = np.linalg.norm(first + second, axis=-1)
    distance = _softened(np.linalg.norm(wanted, axis=-1), present, a + b, soft)
    distance = _unfolded(distance, present, np.abs(a - b), soft * (a + b))
    cosine = (distance**2 - a**2 - b**2) / np.maximum(2 * a * b, 1e-12)
    after = np.arccos(np.clip(cosine, -1.0, 1.0))  # nearer than it can fold, it folds

    along = first / np.maximum(a, 1e-12)[:, None]
    normal = np.cross(along, second / np.maximum(b, 1e-12)[:, None])
    sine = np.linalg.norm(normal, axis=-1)
    before = np.arctan2(sine, np.einsum("fi,fi->f", first, second) / np.maximum(a * b, 1e-12))
    level = axis - np.einsum("fi,fi->f", axis, along)[:, None] * along
    level /= np.maximum(np.linalg.norm(level, axis=-1), 1e-12)[:, None]
    normal = np.where(sine[:, None] > 1e-9, normal / np.maximum(sine, 1e-9)[:, None], level)

    # The plane in which it bends lies at `aside` from the limb's usual one. A nearly straight
    # limb that must bend much more turns into the usual plane as it does so.
    aside = np.arctan2(
        np.einsum("fi,fi->f", np.cross(level, normal), along),
        np.einsum("fi,fi->f", level, normal),
    )
    trust = np.clip((before - DOUBTED_BEND) / (TRUSTED_BEND - DOUBTED_BEND), 0.0, 1.0)
    trust = trust * trust * (3.0 - 2.0 * trust)
    share = np.minimum(before / np.maximum(after, 1e-12), 1.0) ** 2
    kept = (trust + (1.0 - trust) * share) * aside
    new_normal = rotate(quaternion_from_rotation_vector(kept[:, None] * along), level)
    straighten = quaternion_from_rotation_vector(-before[:, None] * normal)
    return multiply(quaternion_from_rotation_vector(after[:, None] * new_normal), straighten)


def _softened(wanted: Array, present: Array, full: Array, soft: float) -> Array:
    """Return a distance that never exceeds `full` and leaves `present` as it is."""
    begin = np.minimum(np.maximum((1.0 - soft) * full, present), full)
    room = full - begin
    excess = np.maximum(wanted - begin, 0.0)
    eased = room * -np.expm1(-excess / np.maximum(room, 1e-12))
    return np.minimum(wanted, begin + eased)


def _unfolded(wanted: Array, present: Array, folded: Array, soft: Array) -> Array:
    """Return a distance not less than that of the folded limb; leaves `present` as it is."""
    begin = np.maximum(np.minimum(folded + soft, present), folded)
    room = begin - folded
    lacking = np.maximum(begin - wanted, 0.0)
    eased = room * -np.expm1(-lacking / np.maximum(room, 1e-12))
    return np.asarray(np.maximum(wanted, begin - eased))


def _turned(motion: Motion, world: WorldPoses, joint: int, turn: Array) -> Array:
    """Return the local rotations of a joint whose parent's present frame sees `turn` added.

    Turns of the joints above cancel: each is expressed in the unturned world.
    """
    parent = motion.skeleton.parents[joint]
    if parent < 0:
        return multiply(turn, motion.rotations[:, joint])
    above = world.rotations[:, parent]
    return multiply(multiply(multiply(inverse(above), turn), above), motion.rotations[:, joint])


def _check(motion: Motion, limb: tuple[int, int, int], targets: Array) -> None:
    upper, lower, end = limb
    skeleton: Skeleton = motion.skeleton
    if upper not in skeleton.ancestors(lower) or lower not in skeleton.ancestors(end):
        names = ", ".join(skeleton.names[joint] for joint in limb)
        raise InvalidMotionError(
            f"A limb's three joints must follow one another; {names} do not."
        )
    if np.shape(targets) != (motion.n_frames, 3):
        raise InvalidMotionError(
            f"Targets need shape ({motion.n_frames}, 3), not {np.shape(targets)}."
        )
