"""Contacts that the animator keyed count wherever a take or a body lacks something."""

import numpy as np
import pytest

from solvers.feet import plant_feet
from solvers.motion import find_humanoid_map
from solvers.motion.humanoid import HumanoidMap, detect_contacts
from solvers.motion.skeletons import find_shot_boundaries
from solvers.rotations import quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

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
