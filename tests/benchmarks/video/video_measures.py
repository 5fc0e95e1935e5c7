"""Figures of a take of a video model, with and without the truth."""

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array, Flags
from solvers.feet import find_foot_joints
from solvers.motion import Motion, forward_kinematics
from solvers.rotations import angle_between


def figures_of(motion: Motion, contacts: Flags, truth: Motion | None) -> dict[str, float]:
    """Return the figures of a motion.

    `contacts` are those of the truth, or of the take as it came. Without truth, floating and
    sinking are relative to the middle height of the standing feet.
    """
    positions, feet = forward_kinematics(motion).positions, foot_joints(motion)
    heights = positions[:, feet, 2].min(axis=-1)
    if truth is None:
        off = heights - np.median(heights[contacts]) if contacts.any() else heights * np.nan
    else:
        off = heights - forward_kinematics(truth).positions[:, feet, 2].min(axis=-1)
    found = {
        "jitter, m/s³": jerk(positions, motion.frame_rate),
        "foot slide, cm/s": 100.0 * slide(positions[:, feet], contacts, motion.frame_rate),
        "floats, cm": 100.0 * mean(np.maximum(off, 0.0)[contacts]),
        "sinks, cm": 100.0 * mean(np.maximum(-off, 0.0)[contacts]),
    }
    if truth is None:
        return found
    angles = np.degrees(angle_between(motion.rotations, truth.rotations))
    offset = motion.root_positions[:, :2] - truth.root_positions[:, :2]
    drift = np.linalg.norm(offset - offset.mean(axis=0), axis=-1).mean()
    return {"angle error, °": float(angles.mean()), **found, "root drift, cm": 100.0 * drift}


def foot_joints(motion: Motion) -> NDArray[np.intp]:
    """Return the joints of ankle and toes, left and right."""
    feet = find_foot_joints(motion.skeleton)
    assert feet is not None
    return feet


def jerk(positions: Array, rate: float) -> float:
    """Return the mean third derivative of all joints."""
    return float(np.linalg.norm(np.diff(positions, 3, axis=0) * rate**3, axis=-1).mean())


def slide(feet: Array, contacts: Flags, rate: float) -> float:
    """Return the mean horizontal speed of the slower of ankle and toes in contact, m/s."""
    speed = np.linalg.norm(np.diff(feet[..., :2], axis=0), axis=-1).min(axis=-1) * rate
    return mean(speed[contacts[1:] & contacts[:-1]])


def mean(values: Array) -> float:
    """Return the mean; NaN of nothing."""
    return float(values.mean()) if len(values) else float("nan")
