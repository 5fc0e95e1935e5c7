"""Estimate which part of the sole carries the foot."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.feet.legs import find_legs
from solvers.feet.sole import estimate_loads, measure_standing_heights, sole_points
from solvers.motion import HumanoidMap, Motion, Skeleton, forward_kinematics
from solvers.samples import GaitSettings, walking_gait


def where(points, motion: Motion) -> np.ndarray:
    """Return the positions of points, (n_frames, n_points, 3)."""
    poses = forward_kinematics(motion)
    return np.stack([point.position(poses) for point in points], axis=1)


def test_heel_ball_and_tip_are_level_in_a_flat_footed_rest_pose():
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    rest = walk.with_poses(np.tile([1.0, 0, 0, 0], (30, walk.n_joints, 1)))

    for leg in find_legs(walk.skeleton):
        points = where(sole_points(walk.skeleton, leg), rest)[0]
        assert points.shape == (3, 3)
        assert np.ptp(points[:, 2]) < 1e-9
        assert (np.diff(points[:, 1]) < 0).all()  # from heel to tip, facing -Y


def test_a_foot_without_toes_ends_in_its_end_site():
    names = ("hips", "thigh_l", "calf_l", "foot_l", "foot_l_end")
    offsets = np.array([[0, 0, 0.9], [0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4], [0, -0.15, -0.1]])
    skeleton = Skeleton(names, (-1, 0, 1, 2, 3), offsets)
    still = Motion(skeleton, np.tile([1.0, 0, 0, 0], (1, 5, 1)), offsets[:1], 30.0)
    roles = {"leftUpperLeg": "thigh_l", "leftLowerLeg": "calf_l", "leftFoot": "foot_l"}
    (leg,) = find_legs(skeleton, HumanoidMap(roles))

    points = where(sole_points(skeleton, leg), still)

    assert_allclose(points[0], [[0.1, 0.03, 0.0], [0.1, -0.15, 0.0]], atol=1e-9)


def test_height_of_a_resting_heel_is_measured():
    """From frame 20 on the foot rests; its heel is 3 cm too high and its tip 1 cm too low."""
    points = np.zeros((60, 3, 3))
    points[..., 2] = [0.03, 0.0, -0.01]
    points[:20, :, 0] = np.arange(20)[::-1, None] * 0.05

    heights = measure_standing_heights(points, np.arange(60) >= 15, 60.0)

    assert_allclose(heights, [0.03, 0.0, -0.01], atol=1e-9)


def resting_loads(heights, n_frames: int = 30) -> np.ndarray:
    """Return the loads of points at constant heights, none of which moves."""
    points = np.zeros((n_frames, len(heights), 3))
    points[..., 2] = heights
    return estimate_loads(points, np.zeros(len(heights)), 60.0, 1.0)


@pytest.mark.parametrize(
    ("heights", "carries"),
    [
        ((0.0, 0.06, 0.08, 0.0), 0),
        ((0.06, 0.0, 0.0, 0.06), 1),
        ((0.1, 0.05, 0.0, 0.1), 2),
    ],
)
def test_lowest_point_carries_the_load(heights, carries):
    load = resting_loads(heights)

    assert_allclose(load.sum(axis=1), 1.0)
    assert (load.argmax(axis=1) == carries).all()
    assert load[:, carries].min() > 0.8


def test_level_foot_rests_on_heel_and_ball_instead_of_jittering_toes():
    load = resting_loads((0.0, 0.0, 0.0, 0.0))

    assert_allclose(load[:, 0], load[:, 1])
    assert load[0, 2:].max() < 0.1


def test_slow_point_carries_the_load_of_fast_ones_at_the_same_height():
    """The ball rolls away from a heel that stands."""
    points = np.zeros((30, 4, 3))
    points[:, 1:, 1] = -np.linspace(0.0, 0.5, 30)[:, None]  # 1 m/s at 60 Hz

    assert estimate_loads(points, np.zeros(4), 60.0, 1.0)[:, 0].min() > 0.99


def test_sliding_foot_is_loaded_as_one_that_stands():
    points = np.zeros((30, 4, 3))
    points[..., 2] = [0.0, 0.005, 0.02, 0.0]
    sliding = points + np.linspace(0.0, 0.5, 30)[:, None, None] * [1.0, 0.0, 0.0]

    loads = [estimate_loads(each, np.zeros(4), 60.0, 1.0) for each in (points, sliding)]

    assert_allclose(loads[0], loads[1], atol=1e-12)
