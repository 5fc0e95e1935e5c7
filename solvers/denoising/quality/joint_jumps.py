"""Find where a joint is turned elsewhere from one frame to the next, and stays."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ...motion import Motion
from ...motion.skeletons import shot_ranges
from ...rotations import inverse, multiply, rotation_vector_from_quaternion
from .joint_signals import Signal

N_NEIGHBORS = 3
"""Steps on each side that a jump exceeds. Chosen by hand, as for the path of a body."""
MIN_JUMP_RAD = np.radians(25.0)
"""Smallest jump, radians. Measured: of 172 development takes 29 have a larger one, and those
looked at are errors: hips, necks and flipped hands that turn in one frame."""
MAX_ANGULAR_ACCELERATION = 400.0
"""Largest angular acceleration of a joint that moves, rad/s^2. Measured: it is 25 degrees from
frame to frame at 30 Hz, and 100 at 15 Hz, where 42 of these takes have jumps of 25."""
MIN_RATIO = 4.0
"""Jump as a ratio to the largest of the steps around it. Sweep: with 3, four more of these
takes have jumps."""
MAX_RETURN_S = 0.3
"""Seconds after which a joint that comes back was not turned elsewhere by an error of several
frames, which is a spike. By definition, as in Clean."""


class JointJump(NamedTuple):
    """The first frame in the new direction, and the angle from the expected one, radians."""

    signal: Signal
    frame: int
    angle: float


def find_joint_jumps(
    motion: Motion, signals: tuple[Signal, ...], cuts: tuple[int, ...]
) -> tuple[JointJump, ...]:
    """Return the jumps of joints that do not come back within 0.3 seconds.

    A strap that slips, labels that change or a pose that flips turn a joint in one frame. No
    step before or after shows the speed of such a jump. The ends of a shot are left out: a limb
    may begin in a separate pose (`find_edge_poses`).
    """
    index = motion.skeleton.index
    signal_of = {index(each.joint): each for each in signals if each.is_rotation}
    limit = max(MIN_JUMP_RAD, MAX_ANGULAR_ACCELERATION / motion.frame_rate**2)
    reach = max(round(MAX_RETURN_S * motion.frame_rate), 1) + N_NEIGHBORS
    jumps = []
    for start, stop in shot_ranges(motion, cuts):
        rotations = motion.rotations[start:stop]
        steps = rotation_vector_from_quaternion(
            multiply(inverse(rotations[:-1]), rotations[1:])
        )
        candidates = np.nonzero(_exceed_neighbors(np.linalg.norm(steps, axis=-1), limit))
        for step, joint in zip(*candidates, strict=True):
            frame, signal = start + int(step) + 1, signal_of.get(int(joint))
            if signal is None or not reach <= step < len(steps) - reach:
                continue
            angle = _jump(steps[step - reach : step + reach + 1, joint])
            if angle > limit and not signal.spikes[frame - 1 : frame + 1].any():
                jumps.append(JointJump(signal, frame, angle))
    return tuple(jumps)


def _exceed_neighbors(sizes: Array, limit: float) -> Flags:
    """Return which steps can be jumps, shape (n_steps, n_joints), without their directions."""
    exceed = np.zeros(sizes.shape, dtype=np.bool_)
    if len(sizes) > 2 * N_NEIGHBORS:
        windows = np.lib.stride_tricks.sliding_window_view(sizes, 2 * N_NEIGHBORS + 1, axis=0)
        neighbors = np.delete(windows, N_NEIGHBORS, axis=-1).max(axis=-1)
        middle = windows[..., N_NEIGHBORS]
        is_large = (middle > limit) & (middle >= (MIN_RATIO - 1.0) * neighbors)
        exceed[N_NEIGHBORS:-N_NEIGHBORS] = is_large
    return exceed


def _jump(steps: Array) -> float:
    """Return the angle by which the middle step exceeds those around it, 0 if it returns.

    Parameters
    ----------
    steps : shape (n_steps, 3)
        Rotation vectors. All but the outer ones are compared with their neighbors.
    """
    windows = np.lib.stride_tricks.sliding_window_view(steps, 2 * N_NEIGHBORS + 1, axis=0)
    neighbors = np.delete(windows, N_NEIGHBORS, axis=-1)
    excess = steps[N_NEIGHBORS:-N_NEIGHBORS] - np.median(neighbors, axis=-1)
    middle = len(excess) // 2
    size = float(np.linalg.norm(excess[middle]))
    if not size >= MIN_RATIO * np.linalg.norm(neighbors[middle], axis=0).max():
        return 0.0
    return size if np.linalg.norm(excess.sum(axis=0)) > 0.5 * size else 0.0
