"""Find feet that are dragged over the floor, such as in a shuffle: in contact, but moving."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, Flags
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import HUMAN_LEG_LENGTH_M, SIDES
from ..motion_fitting.goals import BonePoint
from ..signals import smooth_gaussian, two_state_probabilities
from .legs import LegJoints
from .sole import SMOOTHING_S, sole_points
from .support import both_in_contact

STANDING_SPEED, DRAGGED_SPEED = 0.05, 0.3
"""Meters per second, for a leg of 0.9 m: mean speeds of a foot relative to the other one while
both stand, and while one is dragged. Measured: feet of real actors who stand are faster than
0.1 in a tenth of the time (development takes), and made drags of 0.2 are found.
`test_dragged_foot_is_found_at_all_frame_rates` fails without them."""
MEMORY_S = 0.16
"""Seconds of motion that are one independent observation. Chosen by hand: with the rates, a
drag counts from 5 to 10 cm on. The same test fails without it."""
START_RATE, STOP_RATE = 0.2, 3.0
"""Per second, at which a foot that stands is dragged, and one that is dragged stands. Chosen by
hand; the same test fails without them."""
QUARTILE_OF_MEAN = np.log(4.0 / 3.0)
"""Ratio of the lower quartile of an exponential distribution to its mean. By definition."""


def find_dragged_feet(motion: Motion, legs: Sequence[LegJoints], contacts: Flags) -> Flags:
    """Return when a foot in contact is dragged, shape (n_frames, 2), left and right.

    An error of the body's path moves both feet: only the velocity of one relative to the other
    shows that a foot moves. A foot stands if any point of it does: heel, ball, tip or ankle.
    While both feet are in contact, the relative speed of their slowest points has an
    exponential distribution, with one mean if both stand, and another if the faster one is
    dragged. A hidden Markov model adds up the evidence, so that a slow drag counts after some
    centimeters, and jitter or the slow drift of a standing foot do not. Both means are higher
    in a take whose feet never stand, by noise or since they roll.

    Parameters
    ----------
    motion : Motion
    legs : sequence of LegJoints
        Without both, nothing is found.
    contacts : bool, shape (n_frames, 2)
    """
    dragged = np.zeros_like(contacts)
    both = both_in_contact(contacts.all(axis=1))
    if len(legs) < len(SIDES) or not both.any():
        return dragged
    velocities = _sole_velocities(motion, legs)
    slowest = [_slowest(each, 0.0) for each in velocities]
    speeds = np.linalg.norm(slowest, axis=2)
    relatives = [
        np.linalg.norm(_slowest(each, other[:, None]) - other, axis=1)
        for each, other in zip(velocities, reversed(slowest), strict=True)
    ]
    slow = float(np.percentile([each[both] for each in relatives], 25.0))
    typical = slow / QUARTILE_OF_MEAN
    standing = max(STANDING_SPEED, typical)
    moving = max(DRAGGED_SPEED, 2.0 * typical)
    for foot, leg in enumerate(legs):
        relative = np.where(speeds[foot] > speeds[1 - foot], relatives[foot], 0.0)
        log_odds = relative * (1.0 / standing - 1.0 / moving) - np.log(moving / standing)
        of_steps = log_odds * both / (MEMORY_S * motion.frame_rate)
        of_frames = 0.5 * (np.append(of_steps, 0.0) + np.append(0.0, of_steps))
        found = two_state_probabilities(of_frames, motion.frame_rate, START_RATE, STOP_RATE)
        dragged[:, SIDES.index(leg.side)] = found > 0.5
    return dragged & contacts


def _slowest(velocities: Array, reference: Array | float) -> Array:
    """Return the velocity, of points (n_steps, n_points, 2), nearest to a reference."""
    speeds = np.linalg.norm(velocities - reference, axis=2)
    return np.take_along_axis(velocities, speeds.argmin(axis=1)[:, None, None], axis=1)[:, 0]


def _sole_velocities(motion: Motion, legs: Sequence[LegJoints]) -> list[Array]:
    """Return the smoothed horizontal velocities of heel, ball, tip and ankle.

    For each foot they have the shape (n_frames - 1, n_points, 2), from frame to frame, in
    meters per second for a leg of 0.9 m.
    """
    poses, rate, velocities = forward_kinematics(motion), motion.frame_rate, []
    for leg in legs:
        size = leg.length(motion.skeleton) / HUMAN_LEG_LENGTH_M
        points = (*sole_points(motion.skeleton, leg), BonePoint(leg.ankle, np.zeros(3)))
        path = np.stack([point.position(poses)[:, :2] for point in points], axis=1)
        steps = np.diff(path, axis=0).reshape(len(path) - 1, -1) * rate / size
        smooth = smooth_gaussian(steps, SMOOTHING_S * rate)
        velocities.append(smooth.reshape(-1, *path.shape[1:]))
    return velocities
