"""Retarget feet: scaled ankle paths, soles above the ground, and no additional sliding."""

import numpy as np

from ..arrays import Array
from ..motion import Motion
from ..motion.humanoid import HUMAN_LEG_LENGTH_M, UP
from ..motion_fitting import FittedMotion, Goal, fit_in_windows, fit_motion
from ..motion_fitting.goals import (
    BonePoint,
    FollowPosition,
    FollowRotation,
    FollowSource,
    HingeLimit,
    StayAbove,
    StayInPlace,
    flexion_in_reserve,
    hinge_flexion,
    hinge_limit,
    with_bent_hinge,
)
from ..progress import Progress, unwatched
from .body import HumanoidBody
from .foot_paths import FootPath, find_foot_paths
from .hinges import limb_hinge
from .limbs import BLEND_S, Transfer
from .placement import leg_length
from .soles import tip_of
from .stances import LATERAL_AXIS, foot_bone

SWING_M, STANCE_M = 0.005, 0.01
"""Meters, for a leg of 0.9 m, by which ankles may leave their paths: of free and of standing
feet, which must not slide. Chosen by hand; `make sensitivity` varies them."""
SLIDE_M_S = 0.005
"""Meters per second, for a leg of 0.9 m, by which a foot may slide more than the source's. It
guards standing feet (`test_feet_do_not_sink_or_slide_more_than_the_source`)."""
DEPTH_M = 0.001
"""Meters, for a leg of 0.9 m, of a sole below the ground. Chosen by hand; `make sensitivity`
varies it."""
ROOT_M = 0.02
"""Meters, for a leg of 0.9 m, by which the root may move. Half and twice are no better
(`make sensitivity`)."""
HIP_RAD, KNEE_RAD, ANKLE_RAD, TOE_RAD = np.radians([10.0, 10.0, 30.0, 10.0])
"""Radians by which the joints of a leg may turn. Chosen by hand: knees of x0.5 jerk 3 % more
in walks."""
MAX_TOE_FLEXION_RAD = np.radians(32.0)
"""Maximum extension of toes beyond the rest pose to lift their tips. Half and twice gain less
than 1 % (`make sensitivity`)."""
FOOT_RAD = np.radians(3.0)
"""Radians by which a foot may turn in the world. Chosen by hand: x2 turns feet farther; `make
sensitivity` varies it."""


def place_feet(
    transfer: Transfer,
    rotations: Array,
    root_positions: Array,
    softness: float,
    progress: Progress = unwatched,
) -> tuple[Array, Array]:
    """Make the ankles follow the source's paths, transformed by the placement.

    Each foot stands at its own height, its sole stays above the ground, and a standing foot
    slides as far as the source's, scaled. The legs and the root change as little and as
    smoothly as possible; where a leg is too short, the root moves.

    Parameters
    ----------
    transfer : Transfer
    rotations : shape (n_frames, n_joints, 4)
        Local rotations of the target.
    root_positions : shape (n_frames, 3), meters
        Positions of its topmost joint.
    softness : float
        Fraction of a leg kept in reserve, unless the leg is straighter already.
    progress : Progress

    Returns
    -------
    The rotations with new legs, and the new root positions.
    """
    target = transfer.target
    motion = Motion(target.skeleton, rotations, root_positions, transfer.frame_rate)
    paths = find_foot_paths(transfer, motion)
    if not paths:
        return rotations, root_positions
    size = leg_length(target) / HUMAN_LEG_LENGTH_M

    def fit_window(start: int, stop: int, progress: Progress) -> Motion:
        window = motion.slice(start, stop)
        recorded = FittedMotion(window, window, ())
        knees = {
            path.leg[1]: limb_hinge(target, recorded, path.leg, LATERAL_AXIS) for path in paths
        }
        toes = {ball: axis for path in paths for ball, axis in _toe_axis(target, path.side)}
        joints: dict[int, float] = dict.fromkeys(toes, TOE_RAD)
        for path in paths:
            joints |= dict(zip(path.leg, (HIP_RAD, KNEE_RAD, ANKLE_RAD), strict=True))
        fitted = FittedMotion(window, window, tuple(joints), hinges=knees | toes)
        goals: list[Goal] = [FollowSource.of_joints(fitted, ROOT_M * size, joints, BLEND_S)]
        start_of_fit = fitted
        for path in paths:
            goals += _foot_goals(transfer, fitted, path, size, slice(start, stop))
            reserve = flexion_in_reserve(target.rest[list(path.leg)], softness)
            axis = knees[path.leg[1]]
            knee = hinge_limit(fitted, *path.leg[1:], axis, reserve)
            goals.append(knee)
            start_of_fit = with_bent_hinge(start_of_fit, knee)
        return fit_motion(start_of_fit, goals, progress, "Placing the feet").motion

    result = fit_in_windows(motion, fit_window, progress)
    return result.rotations, result.root_positions


def _foot_goals(
    transfer: Transfer, fitted: FittedMotion, path: FootPath, size: float, frames: slice
) -> list[Goal]:
    """Return what a foot has to meet in the frames of a window."""
    in_contact, steps = path.in_contact[frames], slice(frames.start, frames.stop - 1)
    foot, ball = foot_bone(transfer.target, path.side)
    ankle_and_ball = BonePoint(foot, np.zeros(3)), BonePoint(ball, np.zeros(3))
    weight = np.ones((len(in_contact), 3))
    weight[in_contact, :2] = SWING_M / STANCE_M
    stands = (in_contact[1:] & in_contact[:-1])[:, None] * (1.0 - UP)
    goals: list[Goal] = [
        FollowPosition(ankle_and_ball[0], path.ankle[frames], weight, SWING_M * size),
        FollowRotation(foot, fitted.poses.rotations[:, foot], FOOT_RAD),
        StayInPlace(
            ankle_and_ball, path.load[steps], stands, SLIDE_M_S * size, path.steps[steps]
        ),
        *(
            StayAbove(sole.point, height[frames], DEPTH_M * size)
            for sole, height in zip(path.soles, path.heights, strict=True)
        ),
    ]
    if ball in fitted.hinges:
        goals += _toe_limits(transfer.target, fitted, foot, ball)
    return goals


def _toe_axis(target: HumanoidBody, side: str) -> list[tuple[int, Array]]:
    """Return the joint of the toes and their axis, across the foot; nothing without toes."""
    foot, ball = foot_bone(target, side)
    across = np.cross(target.rest[ball] - target.rest[foot], UP)
    has_toes = target.skeleton.parents[ball] == foot and tip_of(target, ball) is not None
    if not has_toes or not across.any():
        return []
    return [(ball, across / np.linalg.norm(across))]


def _toe_limits(target: HumanoidBody, fitted: FittedMotion, foot: int, ball: int) -> list[Goal]:
    """Return what keeps toes from curling and from bending too far."""
    tip, axis = tip_of(target, ball), fitted.hinges[ball]
    if tip is None:
        return []
    bones = np.diff(target.rest[[foot, ball, tip]], axis=0)
    at_rest = np.arctan2(np.cross(*bones) @ axis, bones[0] @ bones[1])
    recorded = hinge_flexion(fitted, ball, tip, axis)
    uncurled = np.minimum(recorded, at_rest)
    extended = np.maximum(recorded, at_rest + MAX_TOE_FLEXION_RAD)
    return [
        HingeLimit(ball, tip, axis, uncurled),
        HingeLimit(ball, tip, -axis, -extended),
    ]
