"""Peers and damages of the benchmark of reconstruction must be what their names say."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import JointRecording, Sensor, Tracks, find_humanoid_map
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS
from solvers.physics.body import build_physics_body
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.peers.one_euro import one_euro
from tests.benchmarks.physics.physics_momentum import impossible_force, outside_cone
from tests.benchmarks.reconstruction.kinect_damage import Damaged, occluded, swapped, without
from tests.benchmarks.reconstruction.kinect_errors import compared
from tests.benchmarks.reconstruction.kinect_folds import observed_postures
from tests.benchmarks.reconstruction.kinect_pairs import Pair

LEFT_HAND, RIGHT_HAND = (POSTURE_JOINTS.index(f"{side}Hand") for side in ("left", "right"))


def standing(n_frames: int = 40) -> np.ndarray:
    """An actor who faces -Y with his arms along his body."""
    pose = {
        "hips": (0, 0, 1.0), "spine": (0, 0, 1.25), "chest": (0, 0, 1.45), "head": (0, 0, 1.7),
    }  # fmt: skip
    for side, x in (("left", 1.0), ("right", -1.0)):
        pose |= {
            f"{side}UpperArm": (0.2 * x, 0, 1.42), f"{side}LowerArm": (0.25 * x, 0, 1.15),
            f"{side}Hand": (0.3 * x, 0, 0.9), f"{side}HandEnd": (0.3 * x, 0, 0.82),
            f"{side}UpperLeg": (0.1 * x, 0, 0.95), f"{side}LowerLeg": (0.1 * x, 0, 0.5),
            f"{side}Foot": (0.1 * x, 0, 0.08), f"{side}Toes": (0.1 * x, -0.15, 0.03),
        }  # fmt: skip
    return np.tile(np.array([pose[name] for name in POSTURE_JOINTS], float), (n_frames, 1, 1))


def test_hand_behind_the_trunk_is_hidden_and_one_next_to_it_is_visible():
    positions = standing()
    positions[:, RIGHT_HAND] = (0.0, 0.3, 1.2)

    where = occluded(positions, 30.0, 0.0)

    assert where[:, RIGHT_HAND].all()
    assert not where[:, LEFT_HAND].any()


def test_hand_in_front_of_the_trunk_is_hidden_from_behind_only():
    positions = standing()
    positions[:, RIGHT_HAND] = (0.0, -0.3, 1.2)

    assert not occluded(positions, 30.0, 0.0)[:, RIGHT_HAND].any()
    assert occluded(positions, 30.0, np.pi)[:, RIGHT_HAND].all()


def test_occlusion_is_equivariant_to_heading():
    positions = standing()
    positions[:, RIGHT_HAND] = (0.0, 0.3, 1.2)
    rotated = positions[..., [1, 0, 2]] * (-1.0, 1.0, 1.0) + (3.0, -2.0, 0.0)

    assert_allclose(occluded(rotated, 30.0, 0.0), occluded(positions, 30.0, 0.0))


def test_damage_removes_or_swaps_the_stated_joints():
    pair = recorded(standing())
    where = np.zeros((40, 20), bool)
    where[5:9, LEFT_HAND] = True

    damaged = observed_postures(without(pair, where))
    arms: Damaged = next(swapped(pair, np.random.default_rng(0)))

    is_observed = np.isfinite(observed_postures(pair)).all(axis=(0, 2))
    assert (np.isnan(damaged).all(axis=-1) == where)[:, is_observed].all()
    rows = arms.where.any(axis=1)
    assert rows.sum() == 15
    assert_allclose(observed_postures(arms.pair)[rows, LEFT_HAND], standing()[rows, RIGHT_HAND])
    assert_allclose(
        observed_postures(arms.pair)[~rows][:, is_observed], standing()[~rows][:, is_observed]
    )


def test_one_euro_smooths_rest_and_passes_fast_motion():
    still = np.full((30, 2), 0.7)
    step = np.repeat([[0.0], [1.0]], 15, axis=0)

    assert_allclose(one_euro(still, 30.0, 1.0, 0.0), still)
    slow, fast = (one_euro(step, 30.0, 0.5, speed_gain)[16, 0] for speed_gain in (0.0, 5.0))
    assert_allclose(slow, 1.0 - (1.0 - 1.0 / (1.0 + 30.0 / np.pi)) ** 2)
    assert fast > 0.8


def test_errors_include_and_exclude_the_constant_offset():
    truth = standing(4)
    made = truth + np.array([0.03, 0.0, 0.0])
    made[0, LEFT_HAND, 2] += 0.04

    absolute, relative, free = compared(made, truth)

    assert_allclose(absolute[1:], 0.03)
    assert_allclose(absolute[0, LEFT_HAND], 0.05)
    assert_allclose(relative[0, [LEFT_HAND, RIGHT_HAND]], [0.04, 0.0], atol=1e-12)
    assert_allclose(free[:, LEFT_HAND], [0.03, 0.01, 0.01, 0.01])


def test_regressions_recover_a_linear_law(rng):
    pytest.importorskip("sklearn")
    from tests.benchmarks.peers import posture_regression as regressions

    features = rng.normal(size=(400, 3))
    offsets = 0.3 + features @ rng.normal(size=(3, 2)) + 0.05 * rng.normal(size=(400, 2))

    for learn in (regressions.ridge, regressions.gaussian_process):
        found = learn(features[:300], offsets[:300])(features[300:])
        assert np.abs(found - offsets[300:]).mean() < 0.1
    constant_offset = regressions.constant(features, offsets)(features[:5])
    assert_allclose(constant_offset, np.tile(offsets.mean(axis=0), (5, 1)))
    assert_allclose(regressions.nearest_mean(np.ones((40, 3)))(features[:4]), 1.0)


def test_only_forces_within_friction_can_come_from_the_ground():
    forces = np.array([[0, 0, 1.0], [1, 0, 1], [1, 0, 0], [0, 0, -1], [0, 2, 0], [-3, 0, -4]])
    assert_allclose(outside_cone(forces), [0, 0, np.sqrt(0.5), 1, np.sqrt(2), 5])


def test_falling_body_needs_no_force_and_hovering_body_its_weight():
    motion = walking_gait(GaitSettings(duration=1.0, frame_rate=100.0))
    body = build_physics_body(motion, find_humanoid_map(motion.skeleton))
    still = np.tile(motion.rotations[:1], (100, 1, 1))
    high = np.tile(motion.root_positions[:1] + np.array([0.0, 0.0, 30.0]), (100, 1))
    time = np.arange(100) / 100.0
    falling = high - [[0.0, 0.0, 0.5 * 9.81 * each**2] for each in time]
    assert impossible_force(body, motion.with_poses(still, high), 0.0) == pytest.approx(1.0)
    assert impossible_force(body, motion.with_poses(still, falling), 0.0) < 0.01


def recorded(positions: np.ndarray) -> Pair:
    tracks = Tracks(POSTURE_JOINTS, positions, 30.0)
    return Pair("m01_s01_e01", JointRecording(tracks, None, Sensor.KINECT_V1), tracks)
