"""The last fit of a skeleton: all joints at once come nearer to where they were observed."""

import numpy as np
import pytest

from solvers import samples
from solvers.motion import forward_kinematics
from solvers.reconstruction.joint_rotations.approach_joints import approach_joints


@pytest.fixture
def walk():
    return samples.walking_gait(samples.GaitSettings(duration=0.5, frame_rate=30.0))


def errors(motion, positions):
    return np.linalg.norm(forward_kinematics(motion).positions - positions, axis=-1)


def turned(walk, rng, size=0.05):
    """Another motion of the same skeleton: all joints turned by some degrees."""
    rotations = walk.rotations + size * rng.normal(size=walk.rotations.shape)
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    return walk.with_poses(rotations, walk.root_positions + 0.02)


def test_positions_that_the_skeleton_can_reach_are_reached(walk):
    positions = forward_kinematics(walk).positions
    near = turned(walk, np.random.default_rng(0))

    found = approach_joints(near, positions, np.ones(positions.shape[:2]))

    assert errors(near, positions).mean() > 0.03
    assert errors(found, positions).mean() < 0.2 * errors(near, positions).mean()


def test_a_motion_that_is_there_stays(walk):
    positions = forward_kinematics(walk).positions

    found = approach_joints(walk, positions, np.ones(positions.shape[:2]))

    np.testing.assert_allclose(found.rotations, walk.rotations, atol=1e-9)
    np.testing.assert_allclose(found.root_positions, walk.root_positions, atol=1e-9)


def test_heavier_joints_come_nearer(walk):
    rng = np.random.default_rng(1)
    positions = forward_kinematics(walk).positions
    positions = positions + 0.03 * rng.normal(size=positions.shape)
    joint = walk.skeleton.index("LeftFoot")
    even = np.ones(positions.shape[:2])
    heavy = even.copy()
    heavy[:, joint] = 20.0

    one, other = (
        errors(approach_joints(walk, positions, weights), positions)[:, joint].mean()
        for weights in (even, heavy)
    )

    assert other < 0.5 * one


def test_missing_joints_and_frames_are_ignored(walk):
    positions = forward_kinematics(walk).positions.copy()
    near = turned(walk, np.random.default_rng(2))
    rotations = near.rotations.copy()
    rotations[3] = np.nan
    near = near.with_poses(rotations, near.root_positions)
    positions[5] = np.nan

    found = approach_joints(near, positions, np.ones(positions.shape[:2]))

    assert np.isnan(found.rotations[3]).all()
    np.testing.assert_allclose(found.rotations[5], near.rotations[5], atol=1e-9)
    known = [0, 1, 2, 4, 6]
    assert errors(found, positions)[known].mean() < 0.2 * errors(near, positions)[known].mean()
