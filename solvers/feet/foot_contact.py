"""When and where a foot bears on the floor: what of its sole must not move."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d  # reflects ends; smooth_gaussian repeats them

from ..arrays import Array, Flags
from ..motion import Motion, WorldPoses
from ..motion.humanoid import HUMAN_LEG_LENGTH_M
from ..motion_fitting.goals import BonePoint
from ..rotations import inverse, multiply, rotation_vector_from_quaternion
from ..signals import find_runs
from .legs import LegJoints
from .sole import SMOOTHING_S, estimate_loads, measure_standing_heights, sole_points

MAX_LEVEL_SPREAD_M = 0.007
"""Meters: the floor is not level if its contacts typically differ by more. Chosen by hand: x0.5
gains 0.5 %, x2 costs 0.4 %."""
MAX_FLOOR_DISTANCE_M = 0.03
"""Meters, for a leg of 0.9 m: a foot planted farther above or below stands on something else.
Chosen by hand: x0.5 gains 0.1 %, x2 costs nothing."""
MIN_LIFT_M = 0.01
"""Meters, for a leg of 0.9 m: a planted sole this far above its contact height may rise. Chosen
by hand: x0.5 gains 0.9 %, x2 costs 0.2 %."""
MAX_FLAT_RATE = 0.6
"""Radians per second: a foot that rotates faster is rolling, not resting. Chosen by hand: x0.5
costs 3.4 %, x2 gains 2.2 %."""


@dataclass(frozen=True, eq=False)
class FootContact:
    """How one foot bears on the floor.

    Attributes
    ----------
    leg : LegJoints
    size : float
        Length of the leg over that of an adult, 0.9 m.
    contact : bool, shape (n_frames,)
    points : sequence of BonePoint
        Heel, ball, tip of the toes if the rig has one, and ankle.
    load : shape (n_frames, n_points)
        Fraction of the load on each point.
    standing_heights : shape (n_points,), meters
        Height of each point above the ball while the whole sole rests.
    floor : float, meters
        Median height of the ball in contact.
    steps : shape (n_frames - 1, 3), 0 to 1
        How certainly the loaded point rests from each frame to the next, by direction.
    on_floor : shape (n_frames,), 0 to 1
        How certainly it is at the height of the floor.
    flat : shape (n_frames - 1,), 0 to 1
        How certainly the foot does not turn.
    """

    leg: LegJoints
    size: float
    contact: Flags
    points: Sequence[BonePoint]
    load: Array
    standing_heights: Array
    floor: float
    steps: Array
    on_floor: Array
    flat: Array

    def slice(self, start: int, stop: int) -> "FootContact":
        """Return the contact in frames `start` up to but without `stop`."""
        return replace(
            self,
            contact=self.contact[start:stop],
            load=self.load[start:stop],
            steps=self.steps[start : stop - 1],
            on_floor=self.on_floor[start:stop],
            flat=self.flat[start : stop - 1],
        )

    def slide(self, poses: WorldPoses) -> float:
        """Return the distance in meters that the loaded part of the sole covers in contact."""
        positions = np.stack([point.position(poses) for point in self.points], axis=1)
        moved = _loaded_displacements(positions, self.load)
        return float(np.linalg.norm(moved[_both_in_contact(self.contact), :2], axis=1).sum())


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
    contact_height = _median_contact_heights(height, contact)
    steps = np.repeat(_both_in_contact(contact)[:, None].astype(np.float64), 3, axis=1)
    steps[:, 2] *= _on_floor(np.abs(height - contact_height), size)
    floor, on_floor = 0.0, np.zeros(motion.n_frames)
    if contact.any():
        floor = float(np.median(height[contact]))
        distance = np.abs(contact_height - floor)
        if np.median(distance[contact]) < MAX_LEVEL_SPREAD_M * size:
            near = contact & (distance < MAX_FLOOR_DISTANCE_M * size)
            on_floor[:-1] = near[:-1] * steps[:, 2]
    flat = _flatness(poses.rotations[:, leg.ankle], contact, load, rate)
    return FootContact(leg, size, contact, points, load, standing, floor, steps, on_floor, flat)


def _both_in_contact(contact: Flags) -> Flags:
    """Return the steps between frames that are both in contact."""
    return np.asarray(contact[1:] & contact[:-1])


def _flatness(rotations: Array, contact: Flags, load: Array, rate: float) -> Array:
    """Return 1 for steps in which a foot rests flat, toward 0 where it rolls.

    It rests flat in contact if heel and ball share the load and it rotates slowly.
    """
    if len(rotations) == 1:
        return np.zeros(0)
    turns = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    velocity = gaussian_filter1d(turns * rate, SMOOTHING_S * rate, axis=0)
    slowness = np.clip(2.0 - 2.0 * np.linalg.norm(velocity, axis=1) / MAX_FLAT_RATE, 0.0, 1.0)
    heel = load[:, 0]
    shared = np.clip(4.0 * heel * (1.0 - heel), 0.0, 1.0)
    return np.asarray(_both_in_contact(contact) * slowness * 0.5 * (shared[1:] + shared[:-1]))


def _loaded_displacements(positions: Array, load: Array) -> Array:
    """Return the displacement of the loaded part of the sole per frame, (n_frames - 1, 3)."""
    mean_load = 0.5 * (load[1:] + load[:-1])
    return np.asarray(np.einsum("fp,fpi->fi", mean_load, np.diff(positions, axis=0)))


def _median_contact_heights(height: Array, contact: Flags) -> Array:
    """Return the median height of each contact; the height itself elsewhere."""
    contact_height = height.copy()
    for start, stop in find_runs(contact):
        contact_height[start:stop] = np.median(height[start:stop])
    return contact_height


def _on_floor(rise: Array, size: float) -> Array:
    """Return 1 for steps on the floor, toward 0 where the entire sole lifts off it."""
    rise = np.maximum(rise[1:], rise[:-1])
    return np.asarray(np.clip(2.0 - rise / (MIN_LIFT_M * size), 0.0, 1.0))
