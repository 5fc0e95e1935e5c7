"""Simulate a piece of a take in which nobody jumps from place to place."""

from dataclasses import dataclass, replace
from itertools import pairwise
from types import ModuleType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, forward_kinematics
from ..motion.humanoid import UP
from ..progress import Progress, within
from ..rotations import inverse, multiply, rotate, twist_about
from .body import PhysicsBody
from .control import controller
from .foot_contacts import with_feet_on_ground
from .plant_target import planted
from .run import follow
from .stance import from_frame_to_frame, in_contact, standing
from .surface import end_joints, measure_clearance, raising, sole_speeds, touching
from .target import away_from, blended, calmed_target
from .world import build_world

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
LONGEST_STEP = 1.0 / 239.0
"""Seconds. 30, 60 and 120 frames a second are then simulated in the same steps, 1/240 s."""

JUMP, FASTEST = 0.05, 12.0
"""Metres, for legs of 0.9 m, and metres per second: a body whose joints go farther on average
from one frame to the next jumps, as between clips that were joined, or out of a T-pose."""

STANDS, SWINGS = 0.3, 0.8
"""Metres per second, for legs of 0.9 m: a sole whose target is slower is held by all its
friction, and by little of it if faster."""

SLIPPERY = 0.05
"""Share of the friction under a foot that swings."""


EASE = 0.3
"""Seconds in which the result eases to what it was where something failed."""

SUNK = 0.001
"""Metres, for legs of 0.9 m, by which no foot is planted if the body then sinks deeper."""

TRIES = 4
LEAST_CALM, CALMEST = 0.005, 0.16
"""Seconds of smoothing: what is at least doubled to try again, and where that ends, for beyond
there is little left of a motion."""

HANGING = 0.75
"""Share of the help from outside which a body that goes by itself does not use on average."""


class Conditions(NamedTuple):
    """In what a body is simulated: see `SimulateSettings`."""

    ground: float
    response: float
    smoothing: float
    friction: float
    support: float
    plant: bool


@dataclass(frozen=True, eq=False)
class Piece:
    """What was simulated of a piece: see `Simulated`.

    `n_lost` counts how often it was lost. `loads` is by how much the ground carries each end of
    `PhysicsBody.grounded`, as a share of the weight, and `stands` how firmly the feet of the
    target stand, shape (n_frames, 2), 0 to 1.
    """

    motion: Motion
    followed: Flags
    contacts: Flags
    support: Array
    loads: Array
    stands: Array
    n_lost: int
    smoothing: float

    @property
    def trouble(self) -> tuple[int, float]:
        """How badly it went: how often the body was lost, and how much it was held."""
        return self.n_lost, float(self.support.mean())


def find_pieces(body: PhysicsBody, motion: Motion) -> list[tuple[int, int]]:
    """Return first frame and stop of each piece in which the body does not jump."""
    positions = forward_kinematics(motion).positions[:, list(body.joints)]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1).mean(axis=1)
    jumps = np.flatnonzero(steps > JUMP * body.size + FASTEST * motion.dt) + 1
    return list(pairwise([0, *(int(jump) for jump in jumps), motion.n_frames]))


def simulated_piece(
    engine: ModuleType,
    body: PhysicsBody,
    motion: Motion,
    conditions: Conditions,
    progress: Progress,
) -> Piece:
    """Let the body follow a piece without gaps.

    One that shakes faster than muscles can move throws its body about. Where the body is lost,
    or hangs on the help from outside, it tries again with a target that is calmed twice as
    much, up to three times; what went best is returned.
    """
    best, start = None, 0.0
    for smoothing in _smoothings(conditions.smoothing):
        stop = (1.0 + start) / 2
        tried = _tried(
            engine, body, motion, conditions, smoothing, within(progress, start, stop)
        )
        if best is None or tried.trouble < best.trouble:
            best = tried
        if best.trouble <= (0, HANGING * conditions.support):
            break
        start = stop
    assert best is not None
    return _planted(body, best, conditions.ground) if conditions.plant else best


def _smoothings(asked: float) -> list[float]:
    """Return by how many seconds each try is calmed: first as asked, then twice as much."""
    calmest = max(asked, CALMEST)
    least = max(asked, LEAST_CALM)
    more = [min(least * 2**doublings, calmest) for doublings in range(1, TRIES)]
    return list(dict.fromkeys([asked, *more]))


def _planted(body: PhysicsBody, piece: Piece, ground: float) -> Piece:
    """Return the piece with feet that stay where they stand, as far as the body follows."""
    firm = standing(body, piece.motion, piece.loads, piece.stands, ground)
    firm *= piece.followed[:, None]
    motion = planted(body, piece.motion, from_frame_to_frame(firm), ground)
    before, after = (
        np.minimum(measure_clearance(body, each, ground), 0.0)
        for each in (piece.motion, motion)
    )
    share = away_from(after < before - SUNK * body.size, EASE * motion.frame_rate)
    motion = blended(piece.motion, motion, body.joints, share)
    return replace(piece, motion=motion, contacts=touching(body, motion, ground))


def _tried(
    engine: ModuleType,
    body: PhysicsBody,
    motion: Motion,
    conditions: Conditions,
    smoothing: float,
    progress: Progress,
) -> Piece:
    """Simulate a piece once.

    It is simulated where it starts at the origin and faces along an axis, so that rounding in
    the engine does not depend on where and which way it was captured.
    """
    ground, friction = conditions.ground, conditions.friction
    places, rotations = _of_moving_joints(body, motion)
    places[:, 2] += raising(
        measure_clearance(body, motion, ground), motion.frame_rate, body.size
    )
    target = calmed_target(places, rotations, motion.frame_rate, smoothing)
    calm = _with_moving_joints(body, motion, target.at_frames())
    speeds = sole_speeds(body, calm)
    firm = np.clip((SWINGS - speeds / body.size) / (SWINGS - STANDS), 0.0, 1.0)
    up = _with_moving_joints(
        body, motion, np.hstack([places, rotations.reshape(len(places), -1)])
    )
    stands = np.where(in_contact(body, calm), firm, 0.0)
    on_ground = with_feet_on_ground(body, up, firm, stands, ground)
    places, rotations = _of_moving_joints(body, on_ground)
    origin, facing = places[0] * (1.0, 1.0, 0.0), twist_about(rotations[0, 0], UP)
    places = rotate(inverse(facing), places - origin)
    rotations[:, 0] = multiply(inverse(facing), rotations[:, 0])
    target = calmed_target(places, rotations, motion.frame_rate, smoothing)
    n_steps = int(np.ceil(motion.dt / LONGEST_STEP))
    course = follow(
        engine,
        build_world(engine, body, ground, friction, motion.dt / n_steps),
        controller(body, conditions.response, conditions.support, friction),
        target,
        np.maximum(firm, SLIPPERY),
        n_steps,
        len(end_joints(body)),
        tell=lambda frame: progress(frame / motion.n_frames, "Simulating"),
    )
    course.places[:, :3] = rotate(facing, course.places[:, :3]) + origin
    course.places[:, 3:7] = multiply(facing, course.places[:, 3:7])
    result = _with_moving_joints(body, motion, course.places)
    contacts = touching(body, result, ground)
    return Piece(
        result,
        course.followed,
        contacts,
        course.support,
        course.loads,
        stands,
        course.n_lost,
        smoothing,
    )


def _of_moving_joints(body: PhysicsBody, motion: Motion) -> tuple[Array, Array]:
    """Return places of the base, (n_frames, 3), and rotations of all that moves; the base's
    are in the world.
    """
    poses = forward_kinematics(motion)
    base = body.joints[0]
    rotations = motion.rotations[:, list(body.joints)]
    rotations[:, 0] = poses.rotations[:, base]
    return poses.positions[:, base].copy(), rotations


def _with_moving_joints(body: PhysicsBody, motion: Motion, places: Array) -> Motion:
    """Return the motion with the simulated joints at these places (see `States`).

    Joints above the base are only shifted.
    """
    base = body.joints[0]
    turns = places[:, 3:].reshape(len(places), -1, 4)
    rotations = motion.rotations.copy()
    rotations[:, list(body.joints)] = turns
    if base:
        above = forward_kinematics(motion).rotations[:, motion.skeleton.parents[base]]
        rotations[:, base] = multiply(inverse(above), turns[:, 0])
    turned = motion.with_poses(rotations)
    shift = places[:, :3] - forward_kinematics(turned).positions[:, base]
    return turned.with_poses(root_positions=turned.root_positions + shift)
