"""When a foot bears on the floor, and which points of its sole must stay in place."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy

from ..arrays import Array, Flags
from ..motion import Motion, WorldPoses
from ..motion.humanoid import HUMAN_LEG_LENGTH_M
from ..motion_fitting.goals import BonePoint
from ..rotations import inverse, multiply, rotation_vector_from_quaternion
from .legs import LegJoints
from .sole import SMOOTHING_S, estimate_loads, measure_standing_heights, sole_points
from .support import Support, both_in_contact, median_contact_heights, resting_steps

MAX_LEVEL_SPREAD_M = 0.007
"""Meters: the floor is not level if its contacts typically differ by more. Half and twice gain
less than 1 % (`make sensitivity`)."""
MAX_FLOOR_DISTANCE_M = 0.03
"""Meters, for a leg of 0.9 m: a foot planted farther above or below stands on something else.
Half and twice are no better (`make sensitivity`)."""
MAX_FLAT_RATE = 0.6
"""Radians per second: a foot that rotates faster is rolling, not resting. Chosen by hand;
`make sensitivity` varies it."""


@dataclass(frozen=True, eq=False)
class FootContact(Support):
    """How one foot bears on the floor.

    Its points are heel, ball, tip of the toes if the rig has one, and ankle.

    Attributes
    ----------
    leg : LegJoints
    standing_heights : shape (n_points,), meters
        Height of each point above the ball while the whole sole rests.
    floor : float, meters
        Median height of the ball in contact.
    on_floor : shape (n_frames,), 0 to 1
        How certainly it is at the height of the floor.
    flat : shape (n_frames - 1,), 0 to 1
        How certainly the foot does not turn.
    """

    leg: LegJoints
    standing_heights: Array
    floor: float
    on_floor: Array
    flat: Array

    def slice(self, start: int, stop: int) -> Self:
        """Return the contact in frames `start` up to but without `stop`."""
        return replace(
            super().slice(start, stop),
            on_floor=self.on_floor[start:stop],
            flat=self.flat[start : stop - 1],
        )

    def held_less(self, factors: Array) -> Self:
        """Return the contact with the loaded points held less firmly.

        Parameters
        ----------
        factors : shape (n_frames,), 1 or more
            How much less.
        """
        weakest = np.maximum(factors[1:], factors[:-1])
        return replace(self, steps=self.steps / weakest[:, None])


def find_foot_contact(
    motion: Motion, poses: WorldPoses, leg: LegJoints, contact: Flags
) -> FootContact:
    """Find out how a foot bears on the floor in the frames of its contacts.

    Parameters
    ----------
    motion : Motion
    poses : WorldPoses
        Of the motion.
    leg : LegJoints
    contact : bool, shape (n_frames,)
    """
    rate, size = motion.frame_rate, leg.length(motion.skeleton) / HUMAN_LEG_LENGTH_M
    points = (*sole_points(motion.skeleton, leg), BonePoint(leg.ankle, np.zeros(3)))
    positions = np.stack([point.position(poses) for point in points], axis=1)
    standing = measure_standing_heights(positions, contact, rate)
    load = estimate_loads(positions, standing, rate, size)
    height = np.sum(load * (positions[..., 2] - standing), axis=1)
    contact_height = median_contact_heights(height, contact)
    steps = resting_steps(height, contact, size)
    floor, on_floor = 0.0, np.zeros(motion.n_frames)
    if contact.any():
        floor = float(np.median(height[contact]))
        distance = np.abs(contact_height - floor)
        if np.median(distance[contact]) < MAX_LEVEL_SPREAD_M * size:
            near = contact & (distance < MAX_FLOOR_DISTANCE_M * size)
            on_floor[:-1] = near[:-1] * steps[:, 2]
    flat = _flatness(poses.rotations[:, leg.ankle], contact, load, rate)
    return FootContact(size, contact, points, load, steps, leg, standing, floor, on_floor, flat)


def _flatness(rotations: Array, contact: Flags, load: Array, rate: float) -> Array:
    """Return 1 for steps in which a foot rests flat, toward 0 where it rolls.

    It rests flat in contact if heel and ball share the load and it rotates slowly.
    """
    if len(rotations) == 1:
        return np.zeros(0)
    rotation_changes = rotation_vector_from_quaternion(
        multiply(rotations[1:], inverse(rotations[:-1]))
    )
    # This filter reflects the ends; smooth_gaussian repeats them.
    velocity = scipy.ndimage.gaussian_filter1d(
        rotation_changes * rate, SMOOTHING_S * rate, axis=0
    )
    slowness = np.clip(2.0 - 2.0 * np.linalg.norm(velocity, axis=1) / MAX_FLAT_RATE, 0.0, 1.0)
    heel = load[:, 0]
    shared = np.clip(4.0 * heel * (1.0 - heel), 0.0, 1.0)
    return np.asarray(both_in_contact(contact) * slowness * 0.5 * (shared[1:] + shared[:-1]))
