"""The sample must walk like a person, or tools that are measured on it are misjudged."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidSettingError
from solvers.motion import forward_kinematics
from solvers.rotations.representations import angle_between
from solvers.samples import GaitSettings, walker_skeleton, walking_gait

TOE_HEIGHT = 0.02
"""Of the toe joint of a standing foot, meters."""


@pytest.fixture(scope="module")
def walk():
    return walking_gait()


def test_walker_is_an_adult_in_t_pose():
    skeleton = walker_skeleton()
    rest_positions = dict(zip(skeleton.names, skeleton.rest_positions, strict=True))

    assert 1.7 < skeleton.height < 1.9
    assert rest_positions["LeftHand"][0] > 0.6 and rest_positions["RightHand"][0] < -0.6
    assert_allclose(rest_positions["LeftHand"][2], rest_positions["LeftShoulder"][2], atol=0.01)
    assert rest_positions["LeftToeBase"][1] < rest_positions["LeftFoot"][1], "toes point to -Y"
    assert rest_positions["LeftToeBase_end"][2] == pytest.approx(TOE_HEIGHT)


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_toes_are_fixed_in_stance(walk, side):
    """About half of the time the toe joint is at standing height, and then it is at rest."""
    toes = positions(walk, f"{side}ToeBase")
    standing = np.abs(toes[:, 2] - TOE_HEIGHT) < 1e-9
    both = standing[1:] & standing[:-1]

    speed = np.linalg.norm(np.diff(toes, axis=0), axis=1) * walk.frame_rate

    assert 0.45 < both.mean() < 0.6
    assert speed[both].max() < 1e-9


def test_walk_always_has_a_foot_on_the_ground(walk):
    low = [positions(walk, f"{side}ToeBase")[:, 2] < 0.05 for side in ("Left", "Right")]

    assert (low[0] | low[1]).all()
    assert 0.05 < (low[0] & low[1]).mean() < 0.5


def test_walk_stays_above_the_floor(walk):
    assert forward_kinematics(walk).positions[..., 2].min() > 0.01


def test_walk_has_the_requested_speed_and_cadence():
    walk = walking_gait(GaitSettings(duration=20.0, speed=1.1, cadence=100.0))

    traveled = np.diff(walk.root_positions[:, :2], axis=0)
    separation = along(walk, "LeftFoot") - along(walk, "RightFoot")
    n_steps = np.count_nonzero(np.diff(np.sign(separation)))

    assert np.linalg.norm(traveled, axis=1).sum() == pytest.approx(22.0, rel=0.05)
    assert traveled[:, 1].sum() < -15.0
    assert n_steps == pytest.approx(20.0 * 100.0 / 60.0, abs=1.5)


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_arms_swing_against_the_legs(walk, side):
    hand, foot = along(walk, f"{side}Hand"), along(walk, f"{side}Foot")

    assert np.corrcoef(hand, foot)[0, 1] < -0.8
    assert 0.25 < np.ptp(hand) < 0.8


@pytest.mark.parametrize("side", ["Left", "Right"])
def test_knees_flex_forward_and_never_lock(walk, side):
    hip, knee, ankle = (positions(walk, side + part) for part in ("UpLeg", "Leg", "Foot"))
    thigh, shin = knee - hip, ankle - knee
    cosine = (
        (thigh * shin).sum(1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shin, axis=1)
    )
    flexion = np.degrees(np.arccos(cosine))

    assert flexion.min() > 2.0
    assert 50.0 < flexion.max() < 70.0
    from_hip_to_ankle = along(walk, f"{side}Foot", f"{side}UpLeg")
    assert (along(walk, f"{side}Leg", f"{side}UpLeg") > 0.5 * from_hip_to_ankle).all()


def test_hips_rise_twice_and_sway_once_per_stride(walk):
    height = walk.root_positions[:, 2]

    assert 0.02 < np.ptp(height) < 0.06
    assert count_cycles(height) == pytest.approx(8.0 * 116 / 60, abs=2)


def test_joints_do_not_jump(walk):
    angles = np.degrees(angle_between(walk.rotations[1:], walk.rotations[:-1]))

    assert angles.max() < 15.0


@pytest.mark.parametrize("part", ["Foot", "Hand", "ToeBase_end"])
def test_feet_and_hands_have_plausible_acceleration(part):
    """Looked at closely enough, a jump of a millimeter would be 1,000 m/s^2 and more."""
    walk = walking_gait(GaitSettings(duration=3.0, frame_rate=480.0))

    acceleration = np.diff(positions(walk, f"Left{part}"), n=2, axis=0) * walk.frame_rate**2

    assert np.linalg.norm(acceleration, axis=1).max() < 100.0


def test_walk_is_the_same_at_every_frame_rate():
    slow = walking_gait(GaitSettings(duration=3.0, frame_rate=60.0, seed=4))
    fast = walking_gait(GaitSettings(duration=3.0, frame_rate=120.0, seed=4))

    assert_allclose(fast.root_positions[::2], slow.root_positions, atol=2e-3)
    assert angle_between(fast.rotations[::2], slow.rotations).max() < np.radians(0.5)


def test_seeds_and_strides_differ():
    first, again, other = (walking_gait(GaitSettings(seed=seed)) for seed in (1, 1, 2))

    assert np.array_equal(first.rotations, again.rotations)
    assert np.degrees(angle_between(first.rotations, other.rotations)).mean() > 1.0


def test_walk_raises_for_steps_beyond_the_legs():
    with pytest.raises(InvalidSettingError, match=r"steps of 1\.80 m, and .* raise cadence"):
        walking_gait(GaitSettings(speed=1.8, cadence=60.0))


@pytest.mark.parametrize(("speed", "cadence"), [(0.4, 60), (0.4, 160), (0.8, 60), (1.8, 130)])
def test_walk_exists_at_the_limits_of_the_settings(speed, cadence):
    walk = walking_gait(GaitSettings(duration=3.0, speed=speed, cadence=cadence))

    assert walk.observed.all()
    assert forward_kinematics(walk).positions[..., 2].min() > 0.0


def test_walk_can_be_a_single_frame():
    assert walking_gait(GaitSettings(duration=0.1, frame_rate=10.0)).n_frames == 1


def positions(motion, name):
    return forward_kinematics(motion).positions[:, motion.skeleton.index(name)]


def along(motion, name, origin="Hips"):
    """How far a joint is ahead of another one in the direction of walking, meters."""
    step = np.gradient(motion.root_positions[:, :2], axis=0)
    step /= np.linalg.norm(step, axis=1, keepdims=True)
    return ((positions(motion, name) - positions(motion, origin))[:, :2] * step).sum(axis=1)


def count_cycles(curve):
    """Number of times that a curve crosses its mean, halved: rises and falls."""
    return np.count_nonzero(np.diff(np.sign(curve - curve.mean()))) / 2
