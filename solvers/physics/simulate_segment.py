"""Simulate a segment of a take without discontinuities."""

from dataclasses import dataclass, replace
from itertools import pairwise
from types import ModuleType
from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import UP
from ..progress import Progress, within
from ..rotations import inverse, multiply, rotate, twist_about
from .body import PhysicsBody
from .body_surface import (
    detect_touching_feet,
    height_correction,
    joints_of_ends,
    measure_clearance,
    measure_sole_speeds,
)
from .control import build_controller
from .follow_target import follow_target
from .foot_placement import place_feet_on_ground
from .foot_support import (
    compute_support_weights,
    detect_target_contacts,
    weights_between_frames,
)
from .plant_target import plant_target_feet, weigh_headings
from .target import smooth_target
from .world import build_world

MAX_STEP_S = 1.0 / 239.0
"""Maximum time step. It gives 30, 60 and 120 frames a second the same steps of 1/240 s. Half
and twice are no better (`make sensitivity`)."""

MAX_JUMP_M, MAX_SPEED_M_S = 0.05, 12.0
"""Meters, for legs of 0.9 m, and meters per second. A greater mean joint displacement between
frames is a discontinuity. They guard takes with joined clips, or with a T-pose at the start
(`test_segments_between_jumps_are_simulated_separately`)."""

STANCE_SPEED_M_S, SWING_SPEED_M_S = 0.3, 0.8
"""Meters per second, for legs of 0.9 m: a sole slower than the first in the target gets full
friction, and one faster than the second only little. Half and twice gain less than 1 %
(`make sensitivity`)."""

MIN_FRICTION_FACTOR = 0.05
"""Fraction of the friction under a swinging foot. Half and twice are no better
(`make sensitivity`)."""


RETRY_SMOOTHINGS_S = (0.04, 0.08, 0.16)
"""Smoothing in seconds of the next attempts, where it is more than requested. They guard takes
that the body does not follow, such as shaking ones; with more, little of a motion remains."""

MAX_SUPPORT_FRACTION = 0.75
"""Fraction of the external force that a body in balance does not use on average. Chosen by
hand; `make sensitivity` varies it."""


class SimulationConditions(NamedTuple):
    """Conditions of a simulation: see `SimulateSettings`."""

    ground: float
    response: float
    smoothing: float
    friction: float
    support: float
    plant: bool


@dataclass(frozen=True, eq=False)
class SimulatedSegment:
    """Result of simulating a segment: see `Simulated`.

    `n_resets` counts resets to the target. `loads` is the upward ground force at each end of
    `PhysicsBody.ground_capsules`, as a fraction of the weight. `stance_weights` is how firmly
    the feet of the target stand, shape (n_frames, 2), 0 to 1.
    """

    motion: Motion
    followed: Flags
    contacts: Flags
    support: Array
    loads: Array
    stance_weights: Array
    n_resets: int
    smoothing: float

    @property
    def badness(self) -> tuple[int, float]:
        """Number of losses, then the mean external force; lower is better."""
        return self.n_resets, float(self.support.mean())


def find_segments(body: PhysicsBody, motion: Motion) -> list[tuple[int, int]]:
    """Return first frame and stop of each segment without a discontinuity."""
    positions = forward_kinematics(motion).positions[:, list(body.joints)]
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=-1).mean(axis=1)
    jumps = np.flatnonzero(steps > MAX_JUMP_M * body.size + MAX_SPEED_M_S * motion.dt) + 1
    return list(pairwise([0, *(int(jump) for jump in jumps), motion.n_frames]))


def simulate_segment(
    engine: ModuleType,
    body: PhysicsBody,
    motion: Motion,
    conditions: SimulationConditions,
    progress: Progress,
) -> SimulatedSegment:
    """Simulate a body that follows a segment without gaps.

    A segment that shakes faster than muscles can move throws its body about. If the body is
    lost or depends on the external force, it tries again with twice the smoothing, up to three
    times. The best attempt is returned.
    """
    best, start = None, 0.0
    for smoothing in _retry_smoothings(conditions.smoothing):
        stop = (1.0 + start) / 2
        attempt = _attempt(
            engine, body, motion, conditions, smoothing, within(progress, start, stop)
        )
        if best is None or attempt.badness < best.badness:
            best = attempt
        if best.badness <= (0, MAX_SUPPORT_FRACTION * conditions.support):
            break
        start = stop
    assert best is not None
    return _plant_segment(body, best, motion, conditions.ground) if conditions.plant else best


def _retry_smoothings(requested: float) -> list[float]:
    """Return the smoothing of each attempt in seconds: as requested first, then more."""
    return [requested, *(more for more in RETRY_SMOOTHINGS_S if more > requested)]


def _plant_segment(
    body: PhysicsBody, segment: SimulatedSegment, take: Motion, ground: float
) -> SimulatedSegment:
    """Return the segment with planted feet.

    A foot that stands in the take turns only where it turns there.
    """
    weights = compute_support_weights(
        body, segment.motion, segment.loads, segment.stance_weights
    )
    weights *= segment.followed[:, None]
    heading_weights = np.maximum(
        weigh_headings(body, segment.motion),
        weigh_headings(body, take) * weights_between_frames(segment.stance_weights),
    )
    motion = plant_target_feet(
        body, segment.motion, weights_between_frames(weights), heading_weights, ground
    )
    return replace(segment, motion=motion, contacts=detect_touching_feet(body, motion, ground))


def _attempt(
    engine: ModuleType,
    body: PhysicsBody,
    motion: Motion,
    conditions: SimulationConditions,
    smoothing: float,
    progress: Progress,
) -> SimulatedSegment:
    """Simulate a segment once.

    It is simulated from the origin with a canonical heading, so that rounding in the engine
    does not depend on the position and heading of the capture.
    """
    ground, friction = conditions.ground, conditions.friction
    coordinates, rotations = _moving_coordinates(body, motion)
    coordinates[:, 2] += height_correction(
        measure_clearance(body, motion, ground), motion.frame_rate, body.size
    )
    target = smooth_target(coordinates, rotations, motion.frame_rate, smoothing)
    smooth = _motion_from_coordinates(body, motion, target.at_frames())
    speeds = measure_sole_speeds(body, smooth)
    slow_weights = np.clip(
        (SWING_SPEED_M_S - speeds / body.size) / (SWING_SPEED_M_S - STANCE_SPEED_M_S), 0.0, 1.0
    )
    raised = _motion_from_coordinates(
        body, motion, np.hstack([coordinates, rotations.reshape(len(coordinates), -1)])
    )
    stance_weights = np.where(detect_target_contacts(body, smooth), slow_weights, 0.0)
    on_ground = place_feet_on_ground(body, raised, slow_weights, stance_weights, ground)
    coordinates, rotations = _moving_coordinates(body, on_ground)
    origin, heading = coordinates[0] * (1.0, 1.0, 0.0), twist_about(rotations[0, 0], UP)
    coordinates = rotate(inverse(heading), coordinates - origin)
    rotations[:, 0] = multiply(inverse(heading), rotations[:, 0])
    target = smooth_target(coordinates, rotations, motion.frame_rate, smoothing)
    n_steps = int(np.ceil(motion.dt / MAX_STEP_S))
    trajectory = follow_target(
        engine,
        build_world(engine, body, ground, friction, motion.dt / n_steps),
        build_controller(body, conditions.response, conditions.support, friction),
        target,
        np.maximum(slow_weights, MIN_FRICTION_FACTOR),
        n_steps,
        len(joints_of_ends(body)),
        report_frame=lambda frame: progress(frame / motion.n_frames, "Simulating"),
    )
    trajectory.coordinates[:, :3] = rotate(heading, trajectory.coordinates[:, :3]) + origin
    trajectory.coordinates[:, 3:7] = multiply(heading, trajectory.coordinates[:, 3:7])
    result = _motion_from_coordinates(body, motion, trajectory.coordinates)
    contacts = detect_touching_feet(body, result, ground)
    return SimulatedSegment(
        result,
        trajectory.followed,
        contacts,
        trajectory.support,
        trajectory.loads,
        stance_weights,
        trajectory.n_resets,
        smoothing,
    )


def _moving_coordinates(body: PhysicsBody, motion: Motion) -> tuple[Array, Array]:
    """Return positions of the base, (n_frames, 3), and rotations of all moving joints; the
    base's are in the world."""
    poses = forward_kinematics(motion)
    base = body.joints[0]
    rotations = motion.rotations[:, list(body.joints)]
    rotations[:, 0] = poses.rotations[:, base]
    return poses.positions[:, base].copy(), rotations


def _motion_from_coordinates(body: PhysicsBody, motion: Motion, coordinates: Array) -> Motion:
    """Return the motion with the simulated joints at these coordinates (see `BodyStates`).

    Joints above the base are only displaced.
    """
    base = body.joints[0]
    moving = coordinates[:, 3:].reshape(len(coordinates), -1, 4)
    rotations = motion.rotations.copy()
    rotations[:, list(body.joints)] = moving
    if base:
        parents = forward_kinematics(motion).rotations[:, motion.skeleton.parents[base]]
        rotations[:, base] = multiply(inverse(parents), moving[:, 0])
    rotated = motion.with_poses(rotations)
    shift = coordinates[:, :3] - forward_kinematics(rotated).positions[:, base]
    return rotated.with_poses(root_positions=rotated.root_positions + shift)
