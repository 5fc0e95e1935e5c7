"""Keep heels, balls and tips of the feet above the ground."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..motion import WorldPoses
from ..rotations import IDENTITY, inverse, multiply, rotate, rotation_between
from ..signals import smoothstep
from .body import HumanoidBody
from .placement import HipPlacement, leg_length, rests_on_ground
from .stances import foot_bone
from .toes import lift_toes, smooth_envelope

DEPTH_TOLERANCE_FRACTION = 0.002
"""Approximate depth below the ground that is allowed, in leg lengths. Chosen by hand: x0.5
costs 0.9 %, x2 gains 1.3 %."""
MIN_SLOPE_SINE, MAX_SLOPE_SINE = np.sin(np.radians([60.0, 80.0]))
"""Sines of a foot's slope: up to the first a rotation lifts its ball, from the second
the complete foot is lifted."""
HEEL_OFFSET_FRACTION = 0.8
"""Distance of the heel behind the ankle, relative to the ankle's height above the sole. Chosen
by hand: x0.5 costs nothing, x2 costs 4.5 %."""
STANDING_COSINE = 0.5
"""Cosine of the sole's tilt above which the heel is below the ankle, not behind it. It guards
actors who kneel down, whose feet would be lifted in one frame."""
UP = np.array([0.0, 0.0, 1.0])


class Depths(NamedTuple):
    """Allowed depths of points of a foot below the ground, each (n_frames,), meters."""

    heel: Array
    ball: Array
    tip: Array


class Sole(NamedTuple):
    """Corrections that keep a foot above the ground."""

    lift: Array
    """Lift of the ankle, shape (n_frames,), meters."""
    rotation: Array
    """World rotation to add to that of the foot, shape (n_frames, 4)."""
    toe_rotation: Array
    """World rotation to add to that of the toes, shape (n_frames, 4)."""


def allowed_depths(
    source: HumanoidBody, source_poses: WorldPoses, side: str, placement: HipPlacement
) -> Depths:
    """Return the allowed depths of a foot: those of the source, if its ground is known.

    The ground is known for sources that rest on height 0, so that a motion retargeted to its
    own body is unchanged. A point that the source lacks, such as the tips of toes of a sensor,
    gets the depth of the point before it.
    """
    foot, ball = foot_bone(source, side)
    depth = np.zeros(len(source_poses.positions))
    if not placement.floors or not rests_on_ground(source):
        return Depths(depth, depth, depth)
    heights = source_poses.positions[..., 2] - placement.floors[0]
    depths = [heights[:, foot] - _heel(source, source_poses, foot)]
    for point in (ball, tip_of(source, ball)):
        is_present = point is not None and point != foot
        depths.append(heights[:, point] - source.rest[point, 2] if is_present else depths[-1])
    return Depths(*(placement.rise * np.maximum(-depth, 0.0) for depth in depths))


def sole_above_ground(
    target: HumanoidBody,
    world: WorldPoses,
    side: str,
    ankle: Array,
    ground: float,
    allowed: Depths,
    frame_rate: float,
) -> Sole:
    """Return the corrections that keep the sole above the ground.

    A heel below the ground lifts the foot. A ball that is still below it is lifted by rotation
    of the foot about the ankle or, for a foot that points steeply down, with the complete foot.
    A tip below the ground extends the toes about the axis across the foot, within the limit of
    toes; the remaining depth is kept.

    Parameters
    ----------
    target : HumanoidBody
    world : WorldPoses
        World poses of the target, for the rotations of the feet.
    side : "left" or "right"
    ankle : shape (n_frames, 3), meters
        Target position of the ankle.
    ground : float, meters
        Height that corresponds to 0 in the rest pose.
    allowed : Depths
    frame_rate : float, hertz
    """
    tolerance = DEPTH_TOLERANCE_FRACTION * leg_length(target)
    foot, ball = foot_bone(target, side)
    rest = target.rest
    height = ankle[:, 2] - ground
    lift = _lift_from_depth(height - _heel(target, world, foot) + allowed.heel, tolerance)
    foot_vector = rotate(world.rotations[:, foot], rest[ball] - rest[foot])
    height = height + foot_vector[:, 2]
    required = _lift_from_depth(height + lift - rest[ball, 2] + allowed.ball, tolerance)
    length = max(float(np.linalg.norm(rest[ball] - rest[foot])), tolerance)
    steep_weight = smoothstep(-foot_vector[:, 2] / length, MIN_SLOPE_SINE, MAX_SLOPE_SINE)
    lift = smooth_envelope(lift + steep_weight * required, frame_rate)
    rotation = _lifting_rotations(
        foot_vector, _lift_from_depth(height + lift - rest[ball, 2] + allowed.ball, tolerance)
    )
    tip = tip_of(target, ball)
    if ball == foot or tip is None:
        return Sole(lift, rotation, rotation)
    toes = rotate(world.rotations[:, ball], rest[tip] - rest[ball])
    height = ankle[:, 2] + lift + rotate(rotation, foot_vector)[:, 2] + toes[:, 2] - ground
    required = _lift_from_depth(height - rest[tip, 2] + allowed.tip, tolerance)
    feet = multiply(rotation, world.rotations[:, foot])
    return Sole(
        lift, rotation, lift_toes(rest[[foot, ball, tip]], feet, toes, required, frame_rate)
    )


def with_sole(
    target: HumanoidBody, rotations: Array, world: WorldPoses, side: str, sole: Sole
) -> Array:
    """Return local rotations, shape (n_frames, n_joints, 4), with new feet and toes."""
    foot, ball = foot_bone(target, side)
    result = rotations.copy()
    rotated = multiply(sole.rotation, world.rotations[:, foot])
    parent = world.rotations[:, target.skeleton.parents[foot]]
    result[:, foot] = multiply(inverse(parent), rotated)
    if tip_of(target, ball) is not None and target.skeleton.parents[ball] == foot:
        toes = multiply(sole.toe_rotation, world.rotations[:, ball])
        result[:, ball] = multiply(inverse(rotated), toes)
    return result


def tip_of(body: HumanoidBody, ball: int) -> int | None:
    """Return the end of the toes; None without one."""
    return next(iter(body.skeleton.children[ball]), None)


def _heel(body: HumanoidBody, world: WorldPoses, foot: int) -> Array:
    """Return the ankle height for which the heel is at height 0, shape (n_frames,)."""
    upright = rotate(world.rotations[:, foot], UP)[:, 2]
    return np.asarray(
        body.rest[foot, 2]
        * (
            HEEL_OFFSET_FRACTION
            + (1.0 - HEEL_OFFSET_FRACTION) * smoothstep(upright, 0.0, STANDING_COSINE)
        )
    )


def _lift_from_depth(height: Array, tolerance: float) -> Array:
    """Return the smooth lift of points below height 0, shape (n_frames,).

    Small depths are lifted less; at most twice the tolerance of the depth remains.
    """
    depth = np.maximum(-height, 0.0)
    return np.asarray(depth**2 / (depth + 2.0 * tolerance))


def _lifting_rotations(foot_vector: Array, lift: Array) -> Array:
    """Return the rotations, (n_frames, 4), that lift the ends of bones, as far as possible."""
    length = np.linalg.norm(foot_vector, axis=1)
    height = np.clip(foot_vector[:, 2] + lift, -length, length)
    horizontal = np.sqrt(length**2 - height**2)
    direction = (
        foot_vector[:, :2]
        / np.maximum(np.linalg.norm(foot_vector[:, :2], axis=1), 1e-9)[:, None]
    )
    after = np.concatenate([horizontal[:, None] * direction, height[:, None]], axis=1)
    return np.where((lift > 0.0)[:, None], rotation_between(foot_vector, after), IDENTITY)
