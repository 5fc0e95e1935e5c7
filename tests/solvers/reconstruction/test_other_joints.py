"""Thumbs, fingertips and noses move with their bones in any orientation."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import SENSOR_JOINTS, Sensor
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, posture_joint_indices
from solvers.reconstruction.joint_rotations.other_joints import positions_from_postures
from solvers.recordings import read_recording

NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
WRIST, ELBOW = (POSTURE_JOINTS.index(role) for role in ("leftHand", "leftLowerArm"))
THUMB = NAMES.index("ThumbLeft")


@pytest.fixture
def take(recordings):
    recording = read_recording(recordings / "kinect" / "kimore" / "JointPositionExercise1.csv")
    observed = recording.tracks.positions[:60].copy()
    indices = posture_joint_indices(recording.names)
    return observed, observed[:, [indices[role] for role in POSTURE_JOINTS]]


def raised_forearm(postures: np.ndarray, offset: tuple[float, float]) -> np.ndarray:
    """The forearm points straight up, except for `offset` meters."""
    up = postures.copy()
    up[:, WRIST] = up[:, ELBOW] + (*offset, 0.25)
    return up


@pytest.mark.parametrize("reliability", [1.0, 0.0])
def test_thumb_of_a_raised_arm_does_not_flip(take, reliability):
    """The correction moves the forearm by 14 mm."""
    observed, postures = take
    before, after = raised_forearm(postures, (0.01, 0.0)), raised_forearm(postures, (0.0, 0.01))
    direction = np.array([0.05, 0.0, 0.05])
    observed[:, THUMB] = before[:, WRIST] + direction
    weights = np.ones(observed.shape[:2])
    weights[30:, THUMB] = reliability

    found = positions_from_postures(NAMES, observed, weights, before, after)

    assert np.linalg.norm(found[:, THUMB] - after[:, WRIST] - direction, axis=-1).max() < 0.01


def test_joints_follow_a_rotating_bone(take):
    """A forearm that rotates by 90 degrees moves the thumb along."""
    observed, postures = take
    before, after = raised_forearm(postures, (0.0, 0.0)), raised_forearm(postures, (0.0, 0.0))
    after[:, WRIST] = after[:, ELBOW] + (0.25, 0.0, 0.0)
    observed[:, THUMB] = before[:, WRIST] + (0.0, 0.03, 0.05)

    found = positions_from_postures(NAMES, observed, np.ones(observed.shape[:2]), before, after)

    assert_allclose(found[:, THUMB] - after[:, WRIST], np.tile((0.05, 0.03, 0.0), (60, 1)),
                    atol=1e-9)  # fmt: skip


def test_reconstruction_rotates_with_the_body(take):
    observed, before = take
    after = before + np.random.default_rng(3).normal(scale=0.02, size=before.shape)
    weights = np.random.default_rng(4).uniform(size=observed.shape[:2])
    cos, sin = np.cos(2.1), np.sin(2.1)
    rotation = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]]).T

    first = positions_from_postures(NAMES, observed, weights, before, after) @ rotation
    second = positions_from_postures(
        NAMES, observed @ rotation, weights, before @ rotation, after @ rotation
    )

    assert_allclose(second, first, atol=1e-9)
