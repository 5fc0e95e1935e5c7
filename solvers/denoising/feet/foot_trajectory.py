"""Plan the trajectory of one foot so that it does not slide on the floor."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d  # reflects ends; smooth_gaussian repeats them

from ...arrays import Array, Flags
from ...motion import Motion, Skeleton, WorldPoses
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from ...signals import find_runs, smooth_correction
from .legs import LegJoints
from .sole import SMOOTHING_S, estimate_loads, measure_standing_heights, sole_points

ADULT_LEG_M = 0.9
"""Meters, by definition: the leg for which the lengths of this family are given."""
MAX_LEVEL_SPREAD_M = 0.007
"""Meters: the floor is not level if its contacts typically differ by more. Chosen by hand: x0.5
gains 0.6 %, x2 costs 1.4 %."""
MAX_FLOOR_DISTANCE_M = 0.03
"""Meters, for a leg of 0.9 m: a foot planted farther above or below stands on something else.
Chosen by hand: x0.5 gains 0.3 %, x2 costs nothing."""
MIN_LIFT_M = 0.01
"""Meters, for a leg of 0.9 m: a planted sole this far above its contact height may rise. Chosen
by hand: x0.5 gains 1.2 %, x2 costs 1.1 %."""
MAX_SOLE_SPEED = 1.0
"""Meters per second, for a leg of 0.9 m, above which a loaded sole no longer follows its ankle.
Chosen by hand: x0.5 costs 2.3 %, x2 costs 0.7 %."""
MAX_FLAT_RATE = 0.6
"""Radians per second: a foot that rotates faster is rolling, not resting. Chosen by hand: x0.5
costs 6.5 %, x2 gains 5.0 %."""


@dataclass(frozen=True, eq=False)
class FootTrajectory:
    """One leg and the planned trajectory of its foot.

    Attributes
    ----------
    leg : LegJoints
    contact : bool, shape (n_frames,)
    foot_rotation : shape (n_frames, 4)
        World rotation to add to the foot's own.
    toe_rotation : shape (n_frames, 4)
        World rotation to add to the toes' own.
    ankle : shape (n_frames, 3), meters
        Target position of the ankle.
    sole_offsets : shape (n_frames, n_points, 3), meters
        From the ankle to the points of the sole, with the foot rotated.
    load : shape (n_frames, n_points)
        Fraction of the load on each point of the sole.
    """

    leg: LegJoints
    contact: Flags
    foot_rotation: Array
    toe_rotation: Array
    ankle: Array
    sole_offsets: Array
    load: Array

    def slide(self, skeleton: Skeleton, poses: WorldPoses) -> float:
        """Return the distance in meters that the loaded part of the sole covers in contact."""
        displacements = _loaded_displacements(sole_points(skeleton, poses, self.leg), self.load)
        return float(
            np.linalg.norm(displacements[both_in_contact(self.contact), :2], axis=1).sum()
        )


def plan_foot_trajectory(
    motion: Motion,
    poses: WorldPoses,
    leg: LegJoints,
    contact: Flags,
    *,
    blend: float,
    hold: float,
    hold_rotation: bool,
    floor: bool,
) -> FootTrajectory:
    """Plan the trajectory of one foot.

    Parameters
    ----------
    motion : Motion
    poses : WorldPoses
        Of the motion.
    leg : LegJoints
    contact : bool, shape (n_frames,)
    blend : float, seconds
        Time over which corrections fade.
    hold : float, seconds
        A foot that slides for much longer may drift.
    hold_rotation : bool
        Keep a foot that rests flat from rotating.
    floor : bool
        Move contacts near the foot's typical height to that height.
    """
    rate = motion.frame_rate
    size = leg.length(motion.skeleton) / ADULT_LEG_M
    ankle, rotations = poses.positions[:, leg.ankle], poses.rotations[:, leg.ankle]
    points = sole_points(motion.skeleton, poses, leg)
    standing = measure_standing_heights(points, contact, rate)
    load = estimate_loads(points[..., 2] - standing, rate, size)
    foot_rotation = np.tile([1.0, 0.0, 0.0, 0.0], (motion.n_frames, 1))
    if hold_rotation and motion.n_frames > 1:
        foot_rotation = _hold_foot_rotation(rotations, contact, load, rate, blend)
    sole_offsets = rotate(foot_rotation[:, None], points - ankle[:, None])
    points = ankle[:, None] + sole_offsets
    height = np.sum(load * (points[..., 2] - standing), axis=1)
    contact_height = _median_contact_heights(height, contact)
    displacements = _loaded_displacements(points, load)
    contact_weight = both_in_contact(contact) * _plausibility(
        displacements - np.diff(ankle, axis=0), rate, size
    )
    contact_weight = np.repeat(contact_weight[:, None], 3, axis=1)
    contact_weight[:, 2] *= _on_floor(np.abs(height - contact_height), size)
    goal, pulled = np.zeros_like(ankle), np.zeros_like(ankle)
    if floor and contact.any():
        level = np.median(height[contact])
        if np.median(np.abs(contact_height[contact] - level)) < MAX_LEVEL_SPREAD_M * size:
            goal[:, 2] = level - height
            near_level = contact & (
                np.abs(contact_height - level) < MAX_FLOOR_DISTANCE_M * size
            )
            pulled[:-1, 2] = near_level[:-1] * contact_weight[:, 2]
    shift = smooth_correction(
        -displacements * rate, contact_weight, rate, blend, hold=hold, goal=goal, pulled=pulled
    )
    return FootTrajectory(
        leg, contact, foot_rotation, foot_rotation, ankle + shift, sole_offsets, load
    )


def both_in_contact(contact: Flags) -> Flags:
    """Return the steps between frames that are both in contact."""
    return np.asarray(contact[1:] & contact[:-1])


def _hold_foot_rotation(
    rotations: Array, contact: Flags, load: Array, rate: float, blend: float
) -> Array:
    """Return world rotations, (n_frames, 4), that keep a flat resting foot from rotating.

    The foot rests flat in contact if heel and ball share the load and it rotates slowly.
    """
    displacements = rotation_vector_from_quaternion(
        multiply(rotations[1:], inverse(rotations[:-1]))
    )
    angular_velocity = gaussian_filter1d(displacements * rate, SMOOTHING_S * rate, axis=0)
    slowness = np.clip(
        2.0 - 2.0 * np.linalg.norm(angular_velocity, axis=1) / MAX_FLAT_RATE, 0.0, 1.0
    )
    heel = load[:, 0]
    load_balance = np.clip(4.0 * heel * (1.0 - heel), 0.0, 1.0)
    rest_weight = (
        both_in_contact(contact) * slowness * 0.5 * (load_balance[1:] + load_balance[:-1])
    )
    return quaternion_from_rotation_vector(
        smooth_correction(-displacements * rate, rest_weight, rate, blend)
    )


def _loaded_displacements(points: Array, load: Array) -> Array:
    """Return the displacement of the loaded part of the sole per frame, (n_frames - 1, 3)."""
    mean_load = 0.5 * (load[1:] + load[:-1])
    return np.asarray(np.einsum("fp,fpi->fi", mean_load, np.diff(points, axis=0)))


def _median_contact_heights(height: Array, contact: Flags) -> Array:
    """Return the median height of each contact; the height itself elsewhere."""
    contact_height = height.copy()
    for start, stop in find_runs(contact):
        contact_height[start:stop] = np.median(height[start:stop])
    return contact_height


def _plausibility(angular_velocity: Array, rate: float, size: float) -> Array:
    """Return 1 for steps in which the sole follows the ankle, towards 0 at high speeds.

    No foot in contact swings its sole about the ankle at such a speed. Its rotation is wrong,
    and an ankle that compensated for it would jump in turn.
    """
    speed = np.linalg.norm(angular_velocity, axis=1) * rate
    return np.asarray(np.clip(2.0 - speed / (MAX_SOLE_SPEED * size), 0.0, 1.0))


def _on_floor(rise: Array, size: float) -> Array:
    """Return 1 for steps on the floor, towards 0 where the entire sole lifts off it."""
    rise = np.maximum(rise[1:], rise[:-1])
    return np.asarray(np.clip(2.0 - rise / (MIN_LIFT_M * size), 0.0, 1.0))
