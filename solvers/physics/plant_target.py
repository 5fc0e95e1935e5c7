"""Keep standing feet from creeping and slipping."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..feet import find_foot_contact, find_legs
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import SIDES, UP
from ..motion_fitting import FittedMotion, Goal, fit_in_windows, fit_motion
from ..motion_fitting.goals import (
    BonePoint,
    FollowSource,
    StayAbove,
    StayAtHeight,
    StayInPlace,
    StayStill,
    knee_limit,
)
from ..progress import Progress
from ..rotations import inverse, multiply, rotation_vector_from_quaternion
from .body import PhysicsBody
from .body_surface import find_leg_chain, joints_of_ends, lowest_points, select_foot_ends
from .foot_support import humanoid_of

BLEND_S = 0.35
"""Seconds over which a released foot blends to its own motion, and a simulated body to the take
next to a failure. Half and twice are no better (`make sensitivity`)."""

MAX_ROTATION_RATE_RAD_S = 0.6
"""Radians per second: a foot that rotates faster on the ground does so on purpose. Chosen by
hand; `make sensitivity` varies it."""

CREEP_M_S = 0.001
"""Meters per second, for legs of 0.9 m, by which the loaded part of a held sole may creep. It
guards loaded feet against slides (`test_loaded_foot_rests_on_a_fixed_point`)."""

FOOT_ROTATION_RAD_S = np.radians(2.0)
"""Radians per second by which a held foot may turn. Half and twice are no better
(`make sensitivity`)."""

HEIGHT_M = 0.001
"""Meters, for legs of 0.9 m, by which an end of the sole may leave its height. Half and twice
gain less than 1 % (`make sensitivity`)."""

ROOT_M = 0.006
"""Meters, for legs of 0.9 m, by which the root may move. Half and twice are no better
(`make sensitivity`)."""

HIP_RAD, KNEE_RAD, ANKLE_RAD = np.radians([2.5, 6.0, 15.0])
"""Radians by which the joints of a leg may turn. Chosen by hand: knees of x0.5 let walking feet
slide 1 % farther."""

NEAR_M = 0.1
"""Meters, for legs of 0.9 m, above the ground: other parts of the body that come nearer may not
sink. It bounds the run time."""


def weigh_headings(body: PhysicsBody, motion: Motion) -> Array:
    """Return 1 for steps in which a foot keeps its heading, toward 0 where it turns.

    The shape is (n_frames - 1, 2).
    """
    weights, poses = np.zeros((motion.n_frames - 1, len(SIDES))), forward_kinematics(motion)
    for column, side in enumerate(SIDES):
        if chain := find_leg_chain(body, side):
            rotations = poses.rotations[:, chain[-1]]
            changes = rotation_vector_from_quaternion(
                multiply(rotations[1:], inverse(rotations[:-1]))
            )
            rates = np.abs(changes[:, 2]) * motion.frame_rate
            weights[:, column] = np.clip(2.0 - 2.0 * rates / MAX_ROTATION_RATE_RAD_S, 0.0, 1.0)
    return weights


def plant_target_feet(
    body: PhysicsBody,
    motion: Motion,
    hold_weights: Array,
    heading_weights: Array,
    ground: float,
) -> Motion:
    """Return the motion with feet that do not move over the ground while they are held.

    The point that stands (heel, ball, toes or ankle: the lowest and slowest, as in
    `find_foot_contact`) keeps its position, the foot its heading, and all parts of the sole
    their height, so that no foot sinks or rises. The least smooth change of the legs and of the
    root with that is found for all frames at once.

    Parameters
    ----------
    body : PhysicsBody
    motion : Motion
    hold_weights : shape (n_frames - 1, 2), 0 to 1
        How firmly each foot is held from each frame to the next.
    heading_weights : shape (n_frames - 1, 2), 0 to 1
        How firmly the heading of a foot is held that is held.
    ground : float, meters
    """
    chains = {side: find_leg_chain(body, side) for side in SIDES}
    held = {
        side: chain
        for side, chain in chains.items()
        if chain and hold_weights[:, SIDES.index(side)].any()
    }
    if not held:
        return motion
    joints = tuple(joint for chain in held.values() for joint in chain)

    def plant_window(start: int, stop: int, progress: Progress) -> Motion:
        window = motion.slice(start, stop)
        fitted, steps = FittedMotion(window, window, joints), slice(start, stop - 1)
        goals: list[Goal] = [
            FollowSource.of_joints(
                fitted,
                ROOT_M * body.size,
                {
                    joint: tolerance
                    for chain in held.values()
                    for joint, tolerance in zip(
                        chain, (HIP_RAD, KNEE_RAD, ANKLE_RAD), strict=True
                    )
                },
                BLEND_S,
            )
        ]
        for side, chain in held.items():
            column = SIDES.index(side)
            goals += _foot_goals(
                body, fitted, side, hold_weights[steps, column], heading_weights[steps, column]
            )
            goals.append(knee_limit(fitted, *chain[1:], 0.0))
        goals += _ground_goals(body, fitted, tuple(held), ground)
        return fit_motion(fitted, goals, progress).motion

    return fit_in_windows(motion, plant_window)


def _foot_goals(
    body: PhysicsBody,
    fitted: FittedMotion,
    side: str,
    hold_weights: Array,
    heading_weights: Array,
) -> list[Goal]:
    """Return what the sole of a foot has to meet; weights of shape (n_frames - 1,)."""
    motion, poses, ends = fitted.motion, fitted.poses, select_foot_ends(body, side)
    leg = next(
        each for each in find_legs(body.skeleton, humanoid_of(body)) if each.side == side
    )
    held = np.concatenate([hold_weights, [0.0]]) + np.concatenate([[0.0], hold_weights]) > 0.0
    standing = find_foot_contact(motion, poses, leg, held)
    offsets = np.concatenate([each.ends for each in body.ground_capsules])
    points = [
        BonePoint(int(joint), offset)
        for joint, offset in zip(joints_of_ends(body)[ends], offsets[ends], strict=True)
    ]
    in_place = np.sqrt(hold_weights)[:, None] * (1.0 - UP)
    still = np.sqrt(hold_weights * heading_weights)[:, None] * UP
    one_point, all_frames = np.ones((motion.n_frames, 1)), np.ones(motion.n_frames)
    return [
        StayInPlace(standing.points, standing.step_load, in_place, CREEP_M_S * body.size),
        StayStill(leg.ankle, still, FOOT_ROTATION_RAD_S),
        *(
            StayAtHeight(
                [point],
                one_point,
                np.zeros(1),
                point.position(poses)[:, 2],
                all_frames,
                HEIGHT_M * body.size,
            )
            for point in points
        ),
    ]


def _ground_goals(
    body: PhysicsBody, fitted: FittedMotion, held: Sequence[str], ground: float
) -> list[Goal]:
    """Return what keeps all but held feet from sinking: the knee of a low squat."""
    goals: list[Goal] = []
    is_sole = np.any([select_foot_ends(body, side) for side in held], axis=0)
    heights = lowest_points(body, fitted.motion)[..., 2]
    is_near = heights.min(axis=0) < ground + NEAR_M * body.size
    for end in np.flatnonzero(is_near & ~is_sole):
        capsule = body.ground_capsules[end // 2]
        point = BonePoint(capsule.joint, capsule.ends[end % 2])
        least = capsule.radius + np.minimum(heights[:, end], ground)
        goals.append(StayAbove(point, least, HEIGHT_M * body.size))
    return goals
