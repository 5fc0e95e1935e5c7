"""Find the joints that keep their rotation."""

import numpy as np

from ...arrays import Flags
from ...rotations import angle_between, mean_rotation
from .motion import Motion

STILL_RAD = np.radians(0.02)
"""Radians from its mean by which a still joint rotates at most. It guards against rounding in a
file; the joints of an actor who stands still rotate by 0.1 degrees
(`test_rounding_in_a_file_is_no_movement_and_swaying_is`)."""


def still_joints(motion: Motion) -> Flags:
    """Return which joints keep their local rotation, shape (n_joints,).

    NaN is left out; a joint that was never observed does not count as still.
    """
    angles = angle_between(mean_rotation(motion.rotations), motion.rotations)
    is_observed = motion.observed.any(axis=0)
    return np.asarray(is_observed & (np.nan_to_num(angles).max(axis=0) < STILL_RAD))
