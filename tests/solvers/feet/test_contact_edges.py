"""Feet do not jerk where a contact begins or ends."""

import numpy as np
import pytest

from solvers.feet import find_foot_contact, find_legs, plant_feet
from solvers.feet.support import held_steps
from solvers.motion import forward_kinematics
from solvers.motion.humanoid import SIDES
from tests.benchmarks.contacts.made_takes import made_takes


def _accelerations(motion, before, leg, contact):
    """Return the accelerations of heel, ball, tip and ankle, m/s2, (n_frames - 2, n_points)."""
    poses = forward_kinematics(motion)
    foot = find_foot_contact(before, forward_kinematics(before), leg, contact)
    paths = np.stack([point.position(poses) for point in foot.points], axis=1)
    return np.linalg.norm(np.diff(paths, 2, axis=0), axis=2) * motion.frame_rate**2


def test_foot_does_not_jerk_where_it_lands_and_lifts():
    motion = made_takes(60.0)["walk at 0.7 m/s"].motion

    planted = plant_feet(motion)

    for leg in find_legs(motion.skeleton):
        contact = planted.contacts[:, SIDES.index(leg.side)]
        was = _accelerations(motion, motion, leg, contact)
        now = _accelerations(planted.motion, motion, leg, contact)
        edges = np.flatnonzero(contact[1:] != contact[:-1])
        edges = edges[(edges > 3) & (edges < len(now) - 4)]
        assert len(edges) > 5
        for edge in edges:
            near = slice(edge - 4, edge + 4)
            assert now[near].max() < was[near].max() + 2.0


def test_contact_is_held_as_far_as_it_is_believed_at_its_ends_only():
    probability = np.array([0.4, 0.6, 0.7, 0.95, 0.55, 0.99, 0.7, 0.3])

    assert held_steps(probability) == pytest.approx([0.0, 0.25, 0.5, 1.0, 1.0, 0.5, 0.0])


def test_given_contact_is_held_from_its_first_to_its_last_frame():
    contact = np.array([False, True, True, True, False])

    assert held_steps(contact).tolist() == [0.0, 1.0, 1.0, 0.0]
