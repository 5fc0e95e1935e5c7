"""Hands in the actor's frame equal positions computed by hand."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.gestures.hand_tracking import HandEstimator
from solvers.gestures.settings import GestureSettings
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS

CONFIDENT = np.ones(20)


@pytest.fixture
def t_pose():
    """An actor who faces -Y: the right is at -X. Arms of half a meter, wrists 1.3 m apart."""
    positions = np.full((20, 3), np.nan)
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for part, x in (("UpperArm", 0.15), ("LowerArm", 0.40), ("Hand", 0.65)):
            positions[POSTURE_JOINTS.index(side + part)] = (sign * x, 2.0, 1.4)
    return positions


def test_hands_of_a_t_pose(t_pose):
    hands = HandEstimator(GestureSettings()).read(0.0, t_pose, CONFIDENT)

    assert_allclose(hands.right, (1, 0, 0), atol=1e-12)
    assert_allclose(hands.left, (-1, 0, 0), atol=1e-12)
    assert_allclose(hands.between, (0, 0, 0), atol=1e-12)
    assert hands.gap == hands.sideways == hands.latest_gap == pytest.approx(1.3 / 0.5)
    assert hands.reach == pytest.approx(1.0)


def test_forward_follows_the_heading(t_pose):
    t_pose[POSTURE_JOINTS.index("rightHand")] += (0.25, -0.25, 0.1)

    hands = HandEstimator(GestureSettings()).read(0.0, t_pose, CONFIDENT)

    arm = (0.5 + 0.25 + np.hypot(0.25, 0.1)) / 2  # median of both arms' lengths
    assert_allclose(hands.right * arm, (0.25, 0.25, 0.1), atol=1e-12)


def test_single_outlier_has_no_effect(t_pose):
    reader = HandEstimator(GestureSettings())
    for frame in range(3):
        unchanged = reader.read(frame / 30, t_pose, CONFIDENT)
    wild = t_pose.copy()
    wild[POSTURE_JOINTS.index("rightHand")] += 2.0

    hands = reader.read(0.1, wild, CONFIDENT)

    assert_allclose(hands.right, unchanged.right, atol=1e-12)


def test_missing_hand_is_held_briefly(t_pose):
    reader = HandEstimator(GestureSettings(patience=0.2))
    unchanged = reader.read(0.0, t_pose, CONFIDENT)
    uncertain = CONFIDENT.copy()
    uncertain[POSTURE_JOINTS.index("rightHand")] = 0.1

    soon, late = reader.read(0.19, t_pose, uncertain), reader.read(0.21, t_pose, uncertain)

    assert_allclose(soon.right, unchanged.right)
    assert np.isnan(soon.latest_gap)
    assert late is None


def test_both_arms_are_required_but_not_hips_and_head(t_pose):
    for joint in ("rightUpperArm", "rightLowerArm", "rightHand", "leftHand", "leftUpperArm"):
        gapped = t_pose.copy()
        gapped[POSTURE_JOINTS.index(joint)] = np.nan

        assert HandEstimator(GestureSettings()).read(0.0, gapped, CONFIDENT) is None


def test_joints_in_one_point_give_no_hands(t_pose):
    assert HandEstimator(GestureSettings()).read(0.0, 0.05 * t_pose, CONFIDENT) is None
    assert HandEstimator(GestureSettings()).read(0.0, np.zeros((20, 3)), CONFIDENT) is None
