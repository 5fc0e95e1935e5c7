"""Posture joints, normalized heading and position, and other body sizes."""

import numpy as np
import pytest

from solvers.errors import InvalidMotionError
from solvers.motion import SENSOR_JOINTS, Sensor, Tracks
from solvers.motion.humanoid.body_size import (
    estimate_bone_lengths,
    resize_postures,
    segment_lengths,
)
from solvers.motion.humanoid.posture_heading import normalize_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import (
    PARENTS,
    POSTURE_JOINTS,
    posture_joint_indices,
    posture_positions,
    postures_from_motion,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture
def walk():
    return postures_from_motion(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)))


@pytest.mark.parametrize("sensor", list(SENSOR_JOINTS))
def test_every_kinect_tracks_all_posture_joints(sensor):
    names = SENSOR_JOINTS[sensor]
    found = {role: names[index] for role, index in posture_joint_indices(names).items()}
    assert set(found) == set(POSTURE_JOINTS)
    assert found["leftLowerArm"] == "ElbowLeft"
    assert found["rightHandEnd"] == "HandRight"
    assert found["chest"] in {"ShoulderCenter", "SpineShoulder", "SpineChest"}


def test_posture_positions_raise_for_names_without_a_body():
    tracks = Tracks(("LFHD", "RFHD"), np.zeros((3, 2, 3)), 30.0)
    with pytest.raises(InvalidMotionError, match="No body was recognized"):
        posture_positions(tracks)


def test_missing_joints_are_nan_and_others_keep_their_position():
    names = SENSOR_JOINTS[Sensor.KINECT_V1][:12]
    positions = np.random.default_rng(0).normal(size=(4, 12, 3))
    found = posture_positions(Tracks(names, positions, 30.0))
    assert np.isnan(found[:, POSTURE_JOINTS.index("leftFoot")]).all()
    np.testing.assert_array_equal(
        found[:, POSTURE_JOINTS.index("leftLowerArm")], positions[:, 5]
    )


def test_normalized_postures_ignore_position_and_heading(walk):
    moved = rotate_about_vertical(walk, np.full(len(walk), 2.5)) + np.array([3.0, -1.0, 0.2])
    one, other = normalize_postures(walk, 30.0), normalize_postures(moved, 30.0)
    np.testing.assert_allclose(one.postures, other.postures, atol=1e-9)
    np.testing.assert_allclose(other.to_world(other.postures), moved, atol=1e-12)


def test_normalized_posture_faces_forward_with_left_at_plus_x(walk):
    posture = normalize_postures(walk, 30.0).postures.mean(axis=0)
    assert posture[POSTURE_JOINTS.index("leftUpperArm"), 0] > 0.1
    assert (
        posture[POSTURE_JOINTS.index("leftToes"), 1]
        < posture[POSTURE_JOINTS.index("leftFoot"), 1]
    )


def test_unreliable_joints_do_not_change_the_heading(walk):
    wrong = walk.copy()
    arm = POSTURE_JOINTS.index("leftUpperArm")
    wrong[:, arm] += (0.0, 1.0, 0.0)
    reliability = np.ones(walk.shape[:2])
    reliability[:, arm] = 0.0
    believed = np.abs(
        normalize_postures(wrong, 30.0).headings - normalize_postures(walk, 30.0).headings
    ).max()
    uncertain = np.abs(
        normalize_postures(wrong, 30.0, reliability).headings
        - normalize_postures(walk, 30.0, reliability).headings
    ).max()
    assert believed > 0.3
    assert uncertain < 0.01


def test_a_resized_body_has_the_lengths_and_keeps_directions(walk):
    lengths = np.linspace(0.1, 0.5, len(PARENTS))
    resized = resize_postures(walk, lengths)
    bones = estimate_bone_lengths(walk) > 0.0
    np.testing.assert_allclose(
        segment_lengths(resized)[:, bones], np.tile(lengths[bones], (len(walk), 1))
    )
    assert bones.sum() >= 16
    np.testing.assert_allclose(
        resize_postures(resized, estimate_bone_lengths(walk)), walk, atol=1e-3
    )


def test_lengths_ignore_unreliable_frames(walk):
    shin = POSTURE_JOINTS.index("leftFoot")
    wrong = walk.copy()
    wrong[:40, shin] += (0.0, 0.0, 0.4)
    reliability = np.ones(walk.shape[:2])
    reliability[:40, shin] = 0.1
    assert estimate_bone_lengths(wrong, reliability)[shin] == pytest.approx(
        estimate_bone_lengths(walk)[shin], abs=1e-6
    )
    assert abs(estimate_bone_lengths(wrong)[shin] - estimate_bone_lengths(walk)[shin]) > 0.1


def test_bone_never_observed_gets_the_typical_fraction(walk):
    without_fingertip = walk.copy()
    without_fingertip[:, POSTURE_JOINTS.index("leftHandEnd")] = np.nan
    assert (
        0.05
        < estimate_bone_lengths(without_fingertip)[POSTURE_JOINTS.index("leftHandEnd")]
        < 0.15
    )
