"""Poses of the body model follow the joints of any humanoid."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.depth_tracking.body.learn_motion_prior import (
    camera_joints,
    learn_motion_prior,
    poses_from_motion,
)
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.motion import body_motion
from solvers.depth_tracking.body.pose_from_joints import body_from_joints, pose_from_joints
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.errors import InvalidMotionError
from solvers.samples import GaitSettings, walking_gait

ENDS = ("leftHand", "rightHand", "leftFoot", "rightFoot", "leftLowerLeg", "rightLowerArm")


def test_body_follows_the_joints_of_a_walk():
    gait = walking_gait(GaitSettings(duration=1.0, seed=2))
    joints = camera_joints(gait)
    body = body_from_joints(default_body(), joints)

    poses = poses_from_motion(gait)

    found = joint_positions(body, segment_frames(body, poses))
    indices = [JOINTS.index(name) for name in ENDS]
    errors = np.linalg.norm(found - joints, axis=-1)[:, indices]
    assert errors.mean() < 0.03
    assert np.abs(np.diff(poses[:, 6:], axis=0)).max() < 0.5


def test_pose_from_joints_recovers_a_known_pose(rng):
    body = default_body()
    pose = np.zeros(36)
    pose[:6] = (0.2, -0.1, 3.0, 2.5, 0.1, -0.2)
    pose[14:] = rng.uniform(0.05, 0.5, size=22)
    joints = joint_positions(body, segment_frames(body, pose))

    found = pose_from_joints(body, joints)

    again = joint_positions(body, segment_frames(body, found))
    assert_allclose(again, joints, atol=0.006)


def test_lengths_are_measured_between_joints():
    body = default_body(1.6).with_lengths(leftUpperArm=0.3)
    pose = np.linspace(-0.2, 0.2, 36)
    joints = joint_positions(body, segment_frames(body, np.stack([pose, 0.5 * pose])))

    measured = body_from_joints(default_body(), joints)

    for name in ("leftUpperArm", "rightLowerArm", "leftUpperLeg", "hipWidth"):
        assert_allclose(measured.length(name), body.length(name), atol=1e-9)


def test_poses_from_a_motion_of_the_body_are_exact(rng):
    body = default_body()
    poses = np.zeros((5, 36))
    poses[:, 2] = 3.0
    poses[:, 14:] = rng.uniform(0.1, 0.4, size=22) + 0.02 * np.arange(5)[:, np.newaxis]

    again = poses_from_motion(body_motion(body, poses, 30.0))

    joints = [joint_positions(body, segment_frames(body, one)) for one in (poses, again)]
    indices = [JOINTS.index(name) for name in ENDS]
    errors = np.linalg.norm(joints[0] - joints[1], axis=-1)[:, indices]
    assert errors.mean() < 0.02


def test_learn_motion_prior_stores_clip_indices():
    gaits = [walking_gait(GaitSettings(duration=0.5, seed=seed)) for seed in (1, 2)]

    prior = learn_motion_prior(gaits, trained_on="two walks")

    assert prior.poses.shape[1] == 30 and set(prior.clips) == {0, 1}
    assert prior.trained_on == "two walks"


def test_learn_motion_prior_raises_for_an_incomplete_skeleton(swinging_leg):
    with pytest.raises(InvalidMotionError, match="no joint for"):
        learn_motion_prior([swinging_leg])
