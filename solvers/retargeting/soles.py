"""Keep heels, balls and tips of the feet from sinking into the ground."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion import WorldPoses
from ..rotations import IDENTITY, inverse, multiply, rotate, rotation_between
from .body import Body
from .placement import Placement, leg_length, rests_on_ground
from .standing_feet import foot_bone
from .toes import eased, toes_up

Array = NDArray[np.float64]

TOLERANCE = 0.002
"""Part of the leg's length by which points may be below the ground, about."""
LEVEL, STEEP = np.sin(np.radians([60.0, 80.0]))
"""Sines of a foot's slope: up to the first it turns to lift its ball, from the second on all
of it is lifted."""
BEHIND = 0.8
"""How far the heel reaches behind the ankle, parts of the ankle's height above the sole."""
STANDING = 0.5
"""Cosine of the sole's tilt from which on the heel is below the ankle, not behind it."""
UP = np.array([0.0, 0.0, 1.0])


class Depths(NamedTuple):
    """How deep points of a foot may be below the ground, each of shape (n_frames,), metres."""

    heel: Array
    ball: Array
    tip: Array


class Sole(NamedTuple):
    """How a foot must be changed to stay above the ground."""

    lift: Array
    """Of the ankle, shape (n_frames,), metres."""
    turn: Array
    """World rotation to add to the foot's, shape (n_frames, 4)."""
    toe_turn: Array
    """World rotation to add to that of the toes, shape (n_frames, 4)."""


def allowed_depths(source: Body, seen: WorldPoses, side: str, placement: Placement) -> Depths:
    """Return how deep a foot may sink: as deep as the source's, if that is known.

    It is of sources that rest on height 0, so that a body makes its own motion as it is. What
    a source does not have, as sensors know no tips of toes, may sink as deep as what is before
    it.
    """
    foot, ball = foot_bone(source, side)
    depth = np.zeros(len(seen.positions))
    if not placement.floors or not rests_on_ground(source):
        return Depths(depth, depth, depth)
    heights = seen.positions[..., 2] - placement.floors[0]
    depths = [heights[:, foot] - _heel(source, seen, foot)]
    for point in (ball, tip_of(source, ball)):
        known = point is not None and point != foot
        depths.append(heights[:, point] - source.rest[point, 2] if known else depths[-1])
    return Depths(*(placement.rise * np.maximum(-depth, 0.0) for depth in depths))


def sole_above_ground(
    target: Body,
    world: WorldPoses,
    side: str,
    ankle: Array,
    ground: float,
    allowed: Depths,
    frame_rate: float,
) -> Sole:
    """Return what keeps the sole above the ground.

    A sunken heel lifts the foot. A ball that is still sunken is lifted by turning the foot up
    about its ankle, or together with it where the foot points steeply down. A sunken tip turns
    the toes up about the axis across the foot, as far as toes bend; what is left stays sunken.

    Parameters
    ----------
    target : Body
    world : WorldPoses
        Of the target; the feet's rotations are looked at.
    side : "left" or "right"
    ankle : shape (n_frames, 3), metres
        Where the ankle is to be.
    ground : float, metres
        What the rest pose has at height 0.
    allowed : Depths
    frame_rate : float, hertz
    """
    tolerance = TOLERANCE * leg_length(target)
    foot, ball = foot_bone(target, side)
    rest = target.rest
    height = ankle[:, 2] - ground
    lift = _sunk(height - _heel(target, world, foot) + allowed.heel, tolerance)
    way = rotate(world.rotations[:, foot], rest[ball] - rest[foot])
    height = height + way[:, 2]
    lacking = _sunk(height + lift - rest[ball, 2] + allowed.ball, tolerance)
    length = max(float(np.linalg.norm(rest[ball] - rest[foot])), tolerance)
    steep = _rising(-way[:, 2] / length, LEVEL, STEEP)
    lift = eased(lift + steep * lacking, frame_rate)
    turn = _raised(way, _sunk(height + lift - rest[ball, 2] + allowed.ball, tolerance))
    tip = tip_of(target, ball)
    if ball == foot or tip is None:
        return Sole(lift, turn, turn)
    toes = rotate(world.rotations[:, ball], rest[tip] - rest[ball])
    height = ankle[:, 2] + lift + rotate(turn, way)[:, 2] + toes[:, 2] - ground
    lacking = _sunk(height - rest[tip, 2] + allowed.tip, tolerance)
    feet = multiply(turn, world.rotations[:, foot])
    return Sole(lift, turn, toes_up(rest[[foot, ball, tip]], feet, toes, lacking, frame_rate))


def with_sole(
    target: Body, rotations: Array, world: WorldPoses, side: str, sole: Sole
) -> Array:
    """Return local rotations, shape (n_frames, n_joints, 4), with foot and toes turned."""
    foot, ball = foot_bone(target, side)
    result = rotations.copy()
    turned = multiply(sole.turn, world.rotations[:, foot])
    above = world.rotations[:, target.skeleton.parents[foot]]
    result[:, foot] = multiply(inverse(above), turned)
    if tip_of(target, ball) is not None and target.skeleton.parents[ball] == foot:
        toes = multiply(sole.toe_turn, world.rotations[:, ball])
        result[:, ball] = multiply(inverse(turned), toes)
    return result


def tip_of(body: Body, ball: int) -> int | None:
    """Return the end of the toes, if the body has it."""
    return next(iter(body.skeleton.children[ball]), None)


def _heel(body: Body, world: WorldPoses, foot: int) -> Array:
    """Return how high the ankle must be for the heel to be above height 0, (n_frames,)."""
    upright = rotate(world.rotations[:, foot], UP)[:, 2]
    return np.asarray(
        body.rest[foot, 2] * (BEHIND + (1.0 - BEHIND) * _rising(upright, 0.0, STANDING))
    )


def _sunk(height: Array, tolerance: float) -> Array:
    """Return by how much points must rise that are below height 0, smoothly, (n_frames,).

    At first slowly, so that at most twice the tolerance is left of their depth.
    """
    depth = np.maximum(-height, 0.0)
    return np.asarray(depth**2 / (depth + 2.0 * tolerance))


def _raised(way: Array, lift: Array) -> Array:
    """Return the turns, (n_frames, 4), that lift the ends of bones, as far as bones reach."""
    length = np.linalg.norm(way, axis=1)
    height = np.clip(way[:, 2] + lift, -length, length)
    beside = np.sqrt(length**2 - height**2)
    level = way[:, :2] / np.maximum(np.linalg.norm(way[:, :2], axis=1), 1e-9)[:, None]
    after = np.concatenate([beside[:, None] * level, height[:, None]], axis=1)
    return np.where((lift > 0.0)[:, None], rotation_between(way, after), IDENTITY)


def _rising(values: Array, start: float, stop: float) -> Array:
    """Return 0 up to `start`, 1 from `stop` on, smoothly in between, shape (n_frames,)."""
    share = np.clip((values - start) / (stop - start), 0.0, 1.0)
    return np.asarray(share * share * (3.0 - 2.0 * share))
