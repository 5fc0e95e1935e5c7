"""Where one foot should go so that it stands still on the floor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ...motion import Motion, Skeleton, WorldPoses
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from ...signals import runs, smooth_correction
from .legs import Leg
from .sole import CALM, loads, sole_points, standing_heights

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

ADULT_LEG = 0.9
LEVEL = 0.007
"""Metres: a floor whose contacts differ by more, typically, is not level."""
NEAR_FLOOR = 0.03
"""Metres, for a leg of 0.9 m: a foot planted farther above or below stands on something."""
LIFTING = 0.01
"""Metres, for a leg of 0.9 m, above its usual height at which a planted sole is let rise."""
FLUNG = 1.0
"""Metres per second, for a leg of 0.9 m, at which a loaded sole no longer follows its ankle."""
FLAT_TURNING = 0.6
"""Radians per second: a foot that turns faster is rolling, not resting."""


@dataclass(frozen=True, eq=False)
class Plant:
    """One leg and the course that its foot should take.

    Attributes
    ----------
    leg : Leg
    contact : bool, shape (n_frames,)
    turn : shape (n_frames, 4)
        World rotation to add to the foot's own.
    toe_turn : shape (n_frames, 4)
        World rotation to add to the toes' own.
    ankle : shape (n_frames, 3), metres
        Where the ankle should be.
    arms : shape (n_frames, n_points, 3), metres
        From the ankle to the points of the sole, with the foot turned.
    load : shape (n_frames, n_points)
        Part of the load that each point of the sole carries.
    """

    leg: Leg
    contact: Flags
    turn: Array
    toe_turn: Array
    ankle: Array
    arms: Array
    load: Array

    def slide(self, skeleton: Skeleton, poses: WorldPoses) -> float:
        """Return the way in metres that the loaded part of the sole covers in contact."""
        steps = _loaded_steps(sole_points(skeleton, poses, self.leg), self.load)
        return float(np.linalg.norm(steps[within(self.contact), :2], axis=1).sum())


def planted_path(
    motion: Motion,
    poses: WorldPoses,
    leg: Leg,
    contact: Flags,
    *,
    blend: float,
    hold: float,
    hold_rotation: bool,
    floor: bool,
) -> Plant:
    """Plan the course of one foot.

    Parameters
    ----------
    motion : Motion
    poses : WorldPoses
        Of the motion.
    leg : Leg
    contact : bool, shape (n_frames,)
    blend : float, seconds
        Time over which corrections fade.
    hold : float, seconds
        A foot that slides for much longer may creep.
    hold_rotation : bool
        Keep a foot that rests flat from turning.
    floor : bool
        Bring contacts that are near the foot's usual height to that height.
    """
    rate = motion.frame_rate
    size = leg.length(motion.skeleton) / ADULT_LEG
    ankle, rotations = poses.positions[:, leg.ankle], poses.rotations[:, leg.ankle]
    points = sole_points(motion.skeleton, poses, leg)
    standing = standing_heights(points, contact, rate)
    load = loads(points[..., 2] - standing, rate, size)
    turn = np.tile([1.0, 0.0, 0.0, 0.0], (motion.n_frames, 1))
    if hold_rotation and motion.n_frames > 1:
        turn = _stilled(rotations, contact, load, rate, blend)
    arms = rotate(turn[:, None], points - ankle[:, None])
    points = ankle[:, None] + arms
    height = np.sum(load * (points[..., 2] - standing), axis=1)
    usual = _usual_heights(height, contact)
    steps = _loaded_steps(points, load)
    held = within(contact) * _sound(steps - np.diff(ankle, axis=0), rate, size)
    held = np.repeat(held[:, None], 3, axis=1)
    held[:, 2] *= _not_lifting(np.abs(height - usual), size)
    goal, pulled = np.zeros_like(ankle), np.zeros_like(ankle)
    if floor and contact.any():
        level = np.median(height[contact])
        if np.median(np.abs(usual[contact] - level)) < LEVEL * size:
            goal[:, 2] = level - height
            near = contact & (np.abs(usual - level) < NEAR_FLOOR * size)
            pulled[:-1, 2] = near[:-1] * held[:, 2]
    shift = smooth_correction(
        -steps * rate, held, rate, blend, hold=hold, goal=goal, pulled=pulled
    )
    return Plant(leg, contact, turn, turn, ankle + shift, arms, load)


def within(contact: Flags) -> Flags:
    """Return the steps between frames that are both in contact."""
    return np.asarray(contact[1:] & contact[:-1])


def _stilled(rotations: Array, contact: Flags, load: Array, rate: float, blend: float) -> Array:
    """Return world turns, (n_frames, 4), that keep the foot from turning where it rests flat.

    It rests where it is in contact, heel and ball share the load, and it turns slowly.
    """
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    turning = gaussian_filter1d(steps * rate, CALM * rate, axis=0)
    slow = np.clip(2.0 - 2.0 * np.linalg.norm(turning, axis=1) / FLAT_TURNING, 0.0, 1.0)
    heel = load[:, 0]
    shared = np.clip(4.0 * heel * (1.0 - heel), 0.0, 1.0)
    rests = within(contact) * slow * 0.5 * (shared[1:] + shared[:-1])
    return quaternion_from_rotation_vector(smooth_correction(-steps * rate, rests, rate, blend))


def _loaded_steps(points: Array, load: Array) -> Array:
    """Return how the loaded part of the sole moves from frame to frame, (n_frames - 1, 3)."""
    share = 0.5 * (load[1:] + load[:-1])
    return np.asarray(np.einsum("fp,fpi->fi", share, np.diff(points, axis=0)))


def _usual_heights(height: Array, contact: Flags) -> Array:
    """Return, for each contact, the median of its heights; the height itself elsewhere."""
    usual = height.copy()
    for start, stop in runs(contact):
        usual[start:stop] = np.median(height[start:stop])
    return usual


def _sound(turning: Array, rate: float, size: float) -> Array:
    """Return 1 for steps in which the sole follows the ankle, towards 0 where it is flung.

    No foot that stands swings its sole about the ankle at such a speed: its rotation is wrong,
    and an ankle that made up for it would be flung in turn.
    """
    speed = np.linalg.norm(turning, axis=1) * rate
    return np.asarray(np.clip(2.0 - speed / (FLUNG * size), 0.0, 1.0))


def _not_lifting(rise: Array, size: float) -> Array:
    """Return 1 for steps on the floor, towards 0 where the whole sole lifts off it."""
    rise = np.maximum(rise[1:], rise[:-1])
    return np.asarray(np.clip(2.0 - rise / (LIFTING * size), 0.0, 1.0))
