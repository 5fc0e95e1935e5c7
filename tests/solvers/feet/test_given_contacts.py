"""Contacts that the animator keyed count wherever a take or a body lacks something."""

import numpy as np
import pytest

from solvers.feet import plant_feet
from solvers.motion import find_humanoid_map
from solvers.motion.humanoid import HumanoidMap, detect_contacts
from solvers.motion.skeletons import find_shot_boundaries
from solvers.rotations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait
from solvers.signals import find_runs

WALK = walking_gait(GaitSettings(duration=1.5, frame_rate=60.0))


@pytest.mark.parametrize("n_columns", [2, 7])
def test_given_contacts_reach_past_a_separate_pose(n_columns):
    """Such as the one frame of a T-pose with which takes of CMU begin."""
    pose = np.random.default_rng(7).normal(scale=0.3, size=(1, WALK.n_joints, 3))
    motion = WALK.slice(0, 60)
    motion = motion.with_poses(
        np.concatenate([quaternion_from_rotation_vector(pose), motion.rotations]),
        np.concatenate([motion.root_positions[:1], motion.root_positions]),
    )
    contacts = np.zeros((61, n_columns), dtype=bool)
    contacts[:30, 0] = True
    assert find_shot_boundaries(motion) == (1,)

    planted = plant_feet(motion, contacts)

    assert planted.supports.shape == (61, 5)
    assert (planted.contacts == contacts[:, :2]).all()
    assert (planted.motion.rotations[0] == motion.rotations[0]).all()


def test_one_leg_is_planted_at_given_contacts():
    roles = find_humanoid_map(WALK.skeleton).joints
    left = HumanoidMap({role: name for role, name in roles.items() if "right" not in role})
    contacts = detect_contacts(WALK) & [True, False]
    roots = WALK.root_positions * [1.15, 1.15, 1.0]

    planted = plant_feet(WALK.with_poses(root_positions=roots), contacts, humanoid_map=left)

    assert planted.slide_after < 0.02 * planted.slide_before
    assert (planted.contacts == contacts).all()


@pytest.mark.parametrize("n_columns", [2, 7])
def test_contacts_that_are_not_a_number_are_detected(n_columns):
    nothing_given = plant_feet(WALK, np.full((WALK.n_frames, n_columns), np.nan))

    detected = plant_feet(WALK)

    assert (nothing_given.contacts == detected.contacts).all()
    assert (nothing_given.motion.rotations == detected.motion.rotations).all()


def test_one_contact_is_given_and_the_others_are_detected():
    detected = plant_feet(WALK).contacts
    start, stop = find_runs(detected[:, 0])[1]
    given = np.full(detected.shape, np.nan)
    given[start:stop, 0] = 0.0

    planted = plant_feet(WALK, given)

    assert not planted.contacts[start:stop, 0].any()
    planted.contacts[start:stop, 0] = detected[start:stop, 0]
    assert (planted.contacts == detected).all()
