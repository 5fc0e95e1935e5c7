"""Hold planted feet in place while an actor moves."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, WorldPoses, forward_kinematics, reach
from ..motion.humanoid import (
    HUMAN_LEG_LENGTH_M,
    SIDES,
    HumanoidMap,
    detect_contacts,
    foot_noise,
    foot_points,
    leg_length,
)
from ..motion_fitting.goals import BonePoint
from ..rotations import inverse, multiply, quaternion_from_rotation_vector
from .legs import LegJoints, find_legs
from .live_contacts import LiveContacts, RunningLine
from .sole import SPEED_FALLOFF, instant_loads, measure_standing_heights, sole_points

MAX_GAP_S = 0.5
"""Seconds without a frame after which contacts and feet begin again. By definition those after
which a live take begins again."""
RELEASE_RATE = 16.0
"""Per second: rate of the critically damped return of a foot to its captured path. By
definition: 5 % are left after the 0.3 s of Blend (`PlantSettings`)."""
MAX_HOLD_M = 0.15
"""Meters, for a leg of 0.9 m: a foot held farther from its captured path is released. It guards
against contacts that are none, and bounds what a drifting sensor adds up."""
MAX_SLIDE_SPEED = 0.5
"""Meters per second, for a leg of 0.9 m: a foot whose loaded part is faster is lifted, before
the filter is certain of it. It guards swings, which would be late and short."""
RESUME_FRACTION = 0.5
"""Fraction of both limits below which such a foot may be held again. It guards against a foot
that is held and released in every second frame."""


PATCH_RADIUS_M = 0.02
"""Meters, for a leg of 0.9 m: radius of the patch of floor that one point of the sole stands
for, as a heel. It guards a foot that pivots on its ball."""


class PlantedPose(NamedTuple):
    """One frame."""

    motion: Motion
    contacts: Flags
    """Whether the left and the right foot are held, shape (2,)."""


class LivePlanting:
    """Holds each foot in contact where it is, one frame after another.

    In contact a foot is moved and rotated about the vertical so that the loaded part of its
    sole stays where it came down: the sole may roll from heel to ball, and pivot on either.
    Then both changes return to zero like a critically damped spring, from the speed that they
    had, so that neither position nor speed jumps. Only legs and feet rotate: the root keeps its
    path. Nothing that later frames show is used. After a gap feet begin where they are.

    Parameters
    ----------
    calibration : Motion
        Without gaps; the seconds before the first frame.
    humanoid_map : HumanoidMap
        Of its skeleton.
    """

    def __init__(self, calibration: Motion, humanoid_map: HumanoidMap) -> None:
        motion, roles = calibration, humanoid_map
        legs = find_legs(motion.skeleton, roles)
        self._feet: list[_LiveFoot] = []
        if len(legs) < len(SIDES):
            return
        poses, rate = forward_kinematics(motion), motion.frame_rate
        self._contact_points = foot_points(motion.skeleton, roles)
        path = poses.positions[:, self._contact_points]
        size, noise = leg_length(motion.skeleton, roles) / HUMAN_LEG_LENGTH_M, foot_noise(path)
        self._contacts = LiveContacts(rate, size, noise)
        for points in path:
            self._contacts.update(points, motion.dt)
        for leg, contact in zip(legs, detect_contacts(motion, roles).T, strict=True):
            self._feet.append(_LiveFoot(motion, poses, leg, contact, noise))

    @property
    def has_legs(self) -> bool:
        """Whether the skeleton has both legs; otherwise nothing is held."""
        return bool(self._feet)

    def update(self, pose: Motion, elapsed_s: float) -> PlantedPose:
        """Return a pose with the feet held, and which of them are.

        Parameters
        ----------
        pose : Motion
            One frame, without gaps.
        elapsed_s : float, seconds since the last frame
        """
        if not self._feet:
            return PlantedPose(pose, np.zeros(len(SIDES), dtype=np.bool_))
        poses = forward_kinematics(pose)
        points = poses.positions[0, self._contact_points]
        if elapsed_s > MAX_GAP_S:
            self.restart()
        contacts = self._contacts.update(points, elapsed_s) > 0.5
        for foot, is_in_contact in zip(self._feet, contacts, strict=True):
            shift, heading = foot.update(poses, bool(is_in_contact), elapsed_s)
            if shift.any() or heading:
                target = poses.positions[:, foot.leg.ankle] + shift
                pose = reach(pose, foot.leg.chain, target, world=poses)
                pose = _with_heading(pose, poses, foot.leg.ankle, heading)
        return PlantedPose(pose, np.array([foot.is_held for foot in self._feet]))

    def restart(self) -> None:
        """Begin again where the feet are in the next pose, as with another actor."""
        if self._feet:
            self._contacts.restart()
        for foot in self._feet:
            foot.restart()


def _with_heading(pose: Motion, poses: WorldPoses, ankle: int, heading: float) -> Motion:
    """Return the pose with a foot rotated about the vertical, radians.

    `poses` has the foot's rotation before.
    """
    turn = quaternion_from_rotation_vector(np.array([[0.0, 0.0, heading]]))
    foot, rotations = poses.rotations[:, ankle], pose.rotations.copy()
    turned = multiply(inverse(foot), multiply(turn, foot))
    rotations[:, ankle] = multiply(rotations[:, ankle], turned)
    return pose.with_poses(rotations)


class _LiveFoot:
    """One foot, and how far it is moved and rotated from its captured path."""

    def __init__(
        self, motion: Motion, poses: WorldPoses, leg: LegJoints, contact: Flags, noise: float
    ) -> None:
        self.leg = leg
        self._points = (*sole_points(motion.skeleton, leg), BonePoint(leg.ankle, np.zeros(3)))
        self._size = leg.length(motion.skeleton) / HUMAN_LEG_LENGTH_M
        path = np.stack([point.position(poses) for point in self._points], axis=1)
        self._standing = measure_standing_heights(path, contact, motion.frame_rate)
        self._line = RunningLine(motion.frame_rate, noise, SPEED_FALLOFF * self._size)
        for positions in path:
            self._load = self._loads(positions, motion.dt)
        self._last: Array | None = path[-1]
        self._change, self._speed = np.zeros(4), np.zeros(4)
        self._is_slipping = self.is_held = False

    def update(
        self, poses: WorldPoses, is_in_contact: bool, elapsed_s: float
    ) -> tuple[Array, float]:
        """Return the shift of the ankle in meters, (3,), and the foot's rotation in radians.

        The rotation is about the vertical through the ankle.
        """
        positions = np.concatenate([point.position(poses) for point in self._points])
        last, load_before = self._last, self._load
        last = positions if last is None else last
        self._load = self._loads(positions, elapsed_s)
        held = self._hold(positions, last, 0.5 * (self._load + load_before))
        moved = np.linalg.norm(_changed(positions, held) - positions, axis=-1)
        excess = max(
            float(moved.max()) / (MAX_HOLD_M * self._size),
            float(np.linalg.norm(self._velocity)) / (MAX_SLIDE_SPEED * self._size),
        )
        if excess > 1.0:
            self._is_slipping = True
        elif excess < RESUME_FRACTION:
            self._is_slipping = False
        self.is_held = is_in_contact and not self._is_slipping
        if self.is_held:
            self._speed = (held - self._change) / elapsed_s
            self._change = held
        else:
            self._ease_out(elapsed_s)
        self._last = _changed(positions, self._change)
        return self._change[:3], float(self._change[3])

    def restart(self) -> None:
        """Forget the frames so far."""
        self._line.restart()
        self._last, self._change, self._speed = None, np.zeros(4), np.zeros(4)

    def _hold(self, positions: Array, last: Array, load: Array) -> Array:
        """Return the change, (4,), after which the loaded points are where they last were.

        Least squares over the points, weighted by their load. A load on one point leaves the
        heading as captured: the wider it is spread, the more of the heading is held.
        """
        before = self._change[3]
        turned = _changed(positions, np.array([0.0, 0.0, 0.0, before]))
        center, target = load @ turned, load @ last
        (x, y), (to_x, to_y) = (turned - center)[:, :2].T, (last - target)[:, :2].T
        patch = (PATCH_RADIUS_M * self._size) ** 2
        sine, cosine = load @ (x * to_y - y * to_x), load @ (x * to_x + y * to_y)
        heading = before + np.arctan2(sine, cosine + patch)
        rotated = _changed(positions, np.array([0.0, 0.0, 0.0, heading]))
        return np.append(target - load @ rotated, heading)

    def _ease_out(self, elapsed_s: float) -> None:
        """Let the change return to zero, as the exact solution of the spring for a time."""
        decay = np.exp(-RELEASE_RATE * elapsed_s)
        start = self._speed + RELEASE_RATE * self._change
        self._change = (self._change + start * elapsed_s) * decay
        self._speed = (self._speed - RELEASE_RATE * start * elapsed_s) * decay

    def _loads(self, positions: Array, elapsed_s: float) -> Array:
        """Return the fraction of the load on each point, (n_points,); note their velocity."""
        mean, velocities = self._line.update(positions, elapsed_s)
        heights = mean[:, 2] - self._standing
        load = instant_loads(heights, np.linalg.norm(velocities, axis=-1), self._size)
        self._velocity = load @ velocities
        return load


def _changed(positions: Array, change: Array) -> Array:
    """Return points of a foot, ankle last, after a shift and a rotation about the vertical."""
    ankle = positions[-1]
    sine, cosine = np.sin(change[3]), np.cos(change[3])
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    moved: Array = (positions - ankle) @ turn.T + ankle + change[:3]
    return moved
