"""Fit a motion of any rig to posture joints and keep its axial rotations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, forward_kinematics
from solvers.motion.humanoid.posture_heading import rotate_about_vertical
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.reconstruction.joint_rotations.fit_to_postures import (
    fill_motion_gaps,
    fit_motion_to_postures,
)
from solvers.recordings import read_bvh
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

RAISED = np.array([0.0, 0.0, 0.2])


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))


def posture_index(role: str) -> int:
    return POSTURE_JOINTS.index(role)


def test_matching_postures_change_nothing(walk):
    result = fit_motion_to_postures(walk, postures_from_motion(walk))

    assert_allclose(result.rotations, walk.rotations, atol=1e-9)
    assert_allclose(result.root_positions, walk.root_positions, atol=1e-12)


def test_nan_means_no_target(walk):
    postures = np.full((walk.n_frames, 20, 3), np.nan)

    assert_allclose(fit_motion_to_postures(walk, postures).rotations, walk.rotations, atol=1e-9)


@given(st.floats(-3.0, 3.0), st.tuples(*[st.floats(-2.0, 2.0)] * 3))
def test_rotation_and_displacement_of_the_target_are_followed(angle, shift):
    walk = walking_gait(GaitSettings(duration=0.5, frame_rate=20.0))
    expected = rotate_about_vertical(
        postures_from_motion(walk), np.full(walk.n_frames, angle)
    ) + np.array(shift)

    result = fit_motion_to_postures(walk, expected)

    assert_allclose(postures_from_motion(result), expected, atol=1e-6)


def test_fit_raises_an_arm_to_a_raised_target(walk):
    expected = postures_from_motion(walk)
    shoulder = expected[:, posture_index("leftUpperArm")]
    for role in ("leftLowerArm", "leftHand"):
        reach = np.linalg.norm(
            expected[:, posture_index(role)] - shoulder, axis=-1, keepdims=True
        )
        expected[:, posture_index(role)] = shoulder + reach * (0.6, 0.0, 0.8)
    arm = [posture_index(role) for role in ("leftUpperArm", "leftLowerArm", "leftHand")]

    result = fit_motion_to_postures(walk, expected)

    got = postures_from_motion(result)
    assert np.linalg.norm(got - expected, axis=-1)[:, arm].max() < 0.03
    others = [joint for joint in range(20) if not POSTURE_JOINTS[joint].startswith("left")]
    assert_allclose(got[:, others], expected[:, others], atol=1e-9)


def test_fit_keeps_axial_rotations(walk):
    """Forearms keep their axial rotation, and wrists follow them."""
    twist = quaternion_from_rotation_vector(np.array([0.7, 0.0, 0.0]))
    joint = walk.skeleton.names.index(
        next(name for name in walk.skeleton.names if "LeftForeArm" in name)
    )
    rotations = walk.rotations.copy()
    rotations[:, joint] = multiply(rotations[:, joint], twist)
    wrung = walk.with_poses(rotations)
    expected = postures_from_motion(wrung) + RAISED

    result = fit_motion_to_postures(wrung, expected)

    assert_allclose(result.rotations, wrung.rotations, atol=1e-9)
    assert_allclose(result.root_positions, wrung.root_positions + RAISED, atol=1e-9)


def test_real_motion_with_constant_lengths_is_followed_closely(recordings):
    """Apply the poses of one second of a walk to the following second."""
    walk = read_bvh(sorted((recordings / "mocap" / "cmu_walk").glob("*.bvh"))[0])
    first, later = walk.slice(1, 121), walk.slice(121, 241)
    expected = postures_from_motion(later)

    result = fit_motion_to_postures(first, expected)

    miss = np.linalg.norm(postures_from_motion(result) - expected, axis=-1)
    ends = [posture_index(f"{side}{part}") for side in ("left", "right")
            for part in ("LowerArm", "Hand", "LowerLeg", "Foot")]  # fmt: skip
    assert miss[:, ends].mean() < 0.01
    assert np.nanmean(miss) < 0.02


def test_gaps_are_interpolated_along_the_shortest_rotation(walk):
    rotations, positions = walk.rotations.copy(), walk.root_positions.copy()
    rotations[10:13, 2], rotations[:2, 3], positions[5:8] = np.nan, np.nan, np.nan

    result = fill_motion_gaps(walk.with_poses(rotations, positions))

    assert result.observed.all()
    assert_allclose(result.rotations[:2, 3], np.tile(walk.rotations[2, 3], (2, 1)))
    assert_allclose(result.root_positions[5:8, 2], walk.root_positions[5:8, 2], atol=0.01)
    middle = forward_kinematics(result).rotations[11, 2]
    true = forward_kinematics(walk).rotations[11, 2]
    assert abs(middle @ true) > np.cos(np.radians(3.0))


def test_fit_raises_for_postures_with_other_frames(walk):
    with pytest.raises(InvalidMotionError, match=r"shape \(30, 20, 3\)"):
        fit_motion_to_postures(walk, np.zeros((3, 20, 3)))
