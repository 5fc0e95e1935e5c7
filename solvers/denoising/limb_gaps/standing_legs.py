"""Keep a foot where it stood before and after its leg was missing."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...feet import LegJoints, find_legs
from ...motion import Motion
from ...motion.humanoid import HUMAN_LEG_LENGTH_M
from ...motion.skeletons import forward_kinematics, reach
from ...rotations import inverse, multiply, slerp
from ...signals import find_runs
from .adapt_relation import MIN_GAP_S
from .bridges import Bridge

STEP_M, SPEED_M_S = 0.15, 0.5
"""Meters, and meters per second, for a leg of 0.9 m: distance between the places of a foot at
both ends of a gap, and its speed there, at which it may have moved in between. Sweep on the
development takes of the first press: ankles of lost legs come 16 % nearer to the truth; x0.5
and x2 of either move 4 % of that."""
SPEED_S = 0.1
"""Seconds over which that speed is measured. Chosen by hand with SPEED_M_S."""


def keep_standing_feet(motion: Motion, observed: NDArray[np.bool_]) -> Motion:
    """Return the motion with feet in place that stood before and after their leg was missing.

    Joints that are predicted one by one do not add up to a foot on the floor: in a squat the
    foot of a lost leg would sink with the pelvis. The nearer together the places of an ankle at
    both ends of a gap are, and the slower it is there, the nearer to the line between them it
    is kept. Hip and knee follow (`reach`), and the sole turns evenly.

    Parameters
    ----------
    motion : Motion
        Complete.
    observed : shape (n_frames, n_joints)
        Legs change only where hip, knee and ankle are all missing.
    """
    if observed.all():
        return motion
    rotations = motion.rotations.copy()
    for leg in find_legs(motion.skeleton):
        for start, stop in find_runs(~observed[:, leg.chain].any(axis=1)):
            is_inside = start > 0 and stop < motion.n_frames
            if is_inside and stop - start >= MIN_GAP_S * motion.frame_rate:
                kept = _keep_foot(motion, leg, Bridge(start, stop, motion.frame_rate))
                rotations[start:stop, leg.chain] = kept[:, leg.chain]
    return motion.with_poses(rotations)


def _keep_foot(motion: Motion, leg: LegJoints, gap: Bridge) -> Array:
    """Return the rotations of all joints in a gap, shape (n_missing_frames, n_joints, 4)."""
    lag = max(round(SPEED_S * motion.frame_rate), 1)
    first, last = max(gap.start - 1 - lag, 0), min(gap.stop + lag, motion.n_frames - 1)
    nearby = motion.slice(first, last + 1)
    world = forward_kinematics(nearby)
    before, after = gap.start - 1 - first, gap.stop - first
    missing = slice(before + 1, after)
    ankle, sole = world.positions[:, leg.ankle], world.rotations[:, leg.ankle]
    size = leg.length(motion.skeleton) / HUMAN_LEG_LENGTH_M
    moves = np.array([
        _distance(ankle, before, after) / STEP_M,
        _distance(ankle, 0, before) * motion.frame_rate / (max(before, 1) * SPEED_M_S),
        _distance(ankle, after, -1) * motion.frame_rate / (max(last - gap.stop, 1) * SPEED_M_S),
    ])
    weight = np.exp(-0.5 * np.sum((moves / size) ** 2) ** 2)  # flat where all are small
    targets = np.full(ankle.shape, np.nan)
    line = ankle[before] + (ankle[after] - ankle[before]) * gap.phase[:, None]
    targets[missing] = ankle[missing] + weight * (line - ankle[missing])
    even = slerp(sole[before], sole[after], gap.phase)
    sole = slerp(sole[missing], even, np.full(len(even), weight))
    rotations = nearby.rotations.copy()
    shin = world.rotations[missing, motion.skeleton.parents[leg.ankle]]
    rotations[missing, leg.ankle] = multiply(inverse(shin), sole)
    kept = reach(nearby.with_poses(rotations), leg.chain, targets)
    return np.asarray(kept.rotations[missing])


def _distance(positions: Array, frame: int, other: int) -> float:
    return float(np.linalg.norm(positions[other] - positions[frame]))
