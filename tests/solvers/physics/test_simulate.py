"""A simulated motion stands on the ground and stays near its target."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion, detect_contacts, forward_kinematics
from solvers.physics import Ground, SimulateSettings, apply_strength, simulate
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

CENTIMETER = 0.01
AT_ZERO = SimulateSettings(ground=Ground.HEIGHT)


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def simulated(walk):
    return simulate(walk)


@pytest.fixture(scope="module")
def standing(walk):
    """Three seconds in a pose with both feet on the ground."""
    frame = detect_contacts(walk).all(axis=1).argmax()
    return Motion(
        walk.skeleton,
        np.repeat(walk.rotations[frame : frame + 1], 90, axis=0),
        np.repeat(walk.root_positions[frame : frame + 1], 90, axis=0),
        30.0,
    )


def test_simulation_stays_near_a_good_walk_above_the_ground(walk, simulated):
    assert simulated.followed.all()
    assert simulated.message == "The simulated body followed the complete take."
    assert simulated.distance < 3 * CENTIMETER
    assert_allclose(simulated.distance, distance(walk, simulated.motion), atol=0.005)
    assert simulated.penetration_after < 0.5 * CENTIMETER


def test_simulation_keeps_skeleton_frames_and_bone_lengths(walk, simulated):
    result = simulated.motion

    assert result.skeleton is walk.skeleton
    assert (result.n_frames, result.frame_rate) == (walk.n_frames, walk.frame_rate)
    for each in (walk, result):
        positions = forward_kinematics(each).positions
        bones = positions[:, 1:] - positions[:, list(walk.skeleton.parents[1:])]
        lengths = np.linalg.norm(walk.skeleton.offsets[1:], axis=-1)
        assert_allclose(np.linalg.norm(bones, axis=-1), np.tile(lengths, (60, 1)), atol=1e-12)


def test_standing_body_keeps_standing(standing):
    result = simulate(standing)

    assert result.followed.all()
    assert distance(standing, result.motion) < 2 * CENTIMETER
    late = forward_kinematics(result.motion).positions[45:]
    assert np.ptp(late, axis=0).max() < 1 * CENTIMETER
    assert result.contacts[45:].all()
    assert result.support[45:].mean() < 0.15


def test_unsupported_body_falls_freely(standing):
    """In the air, a body without external forces has the acceleration of gravity."""
    high = raised(standing, 1.5).slice(0, 9)

    result = simulate(high, settings=SimulateSettings(support=0.0))

    fall = result.motion.root_positions[:, 2] - high.root_positions[:, 2]
    time = np.arange(5) / 30.0
    assert_allclose(fall[:5], -0.5 * 9.81 * time * (time + 1 / 240), atol=0.01)


@pytest.mark.parametrize("depth", [0.05, 1.0])
def test_body_below_the_floor_is_raised(walk, simulated, depth):
    result = simulate(raised(walk, -depth), settings=AT_ZERO)

    assert result.penetration_before > 0.9 * depth
    assert result.penetration_after < 0.5 * CENTIMETER
    shift = result.motion.root_positions - simulated.motion.root_positions
    assert np.abs(shift).mean() < 1.5 * CENTIMETER


def test_hovering_body_is_lowered(walk, simulated):
    result = simulate(raised(walk, 0.08))

    shift = result.motion.root_positions - simulated.motion.root_positions
    assert np.abs(shift).mean() < 1.5 * CENTIMETER


def test_ground_is_at_the_given_height_or_under_the_feet(walk, simulated):
    up = raised(walk, 3.0)
    given = SimulateSettings(ground_height=3.0)
    found = SimulateSettings(ground=Ground.FEET)

    at_height, under_feet = (simulate(up, settings=each) for each in (given, found))

    assert at_height.ground == 3.0
    assert_allclose(under_feet.ground, 3.0, atol=0.02)
    for each in (at_height, under_feet):
        assert each.followed.all()
        assert distance(raised(simulated.motion, 3.0), each.motion) < 2.5 * CENTIMETER


@pytest.mark.parametrize("height", [-0.73, 1.2])
def test_take_in_camera_space_keeps_its_height(walk, simulated, height):
    result = simulate(raised(walk, height))

    assert_allclose(result.ground, height, atol=0.02)
    assert "far from 0.00 m: the ground is assumed to be under its feet" in result.message
    assert distance(raised(simulated.motion, height), result.motion) < 2.5 * CENTIMETER
    assert "far from" not in simulated.message
    assert simulated.ground == simulate(raised(walk, 0.1)).ground == 0.0


def test_friction_holds_dragged_feet(standing):
    sway = 0.02 * np.sin(2 * np.pi * 1.0 * np.arange(90) / 30.0)
    dragged = standing.with_poses(
        root_positions=standing.root_positions + np.outer(sway, [1.0, 0.5, 0.0])
    )

    held = simulate(dragged)
    icy = simulate(dragged, settings=SimulateSettings(friction=0.0, plant=False))

    assert held.slide_before > 0.2
    assert held.slide_after < 0.1 * held.slide_before
    assert icy.slide_after > 0.9 * icy.slide_before


def test_simulation_reduces_shaking(walk):
    shaking = corrupt(walk, CorruptionSettings(jitter=1.0, root_jitter=0.005))

    result = simulate(shaking)

    assert result.followed.all()
    assert jerk(result.motion) < 0.15 * jerk(shaking)
    assert distance(walk, result.motion) < 0.8 * distance(walk, shaking)


def test_shaking_take_is_smoothed_until_the_body_follows(walk):
    shaking = corrupt(walk, CorruptionSettings(jitter=2.0, root_jitter=0.005))

    result = simulate(shaking)

    assert result.smoothing > SimulateSettings().smoothing
    assert result.message.endswith(f"That required smoothing by {result.smoothing:.2g} s.")
    assert result.followed.all()


def test_more_smoothing_reduces_jerk(walk):
    shaking = corrupt(walk, CorruptionSettings(jitter=0.7))

    default, smooth = (
        simulate(shaking, settings=SimulateSettings(smoothing=smoothing))
        for smoothing in (0.04, 0.08)
    )

    assert jerk(smooth.motion) < 0.7 * jerk(default.motion)


def test_higher_response_follows_closer(walk):
    shaking = corrupt(walk, CorruptionSettings(jitter=0.7))

    soft, stiff = (
        simulate(shaking, settings=SimulateSettings(response=response, smoothing=0.04))
        for response in (1.0, 8.0)
    )

    assert stiff.distance < soft.distance


def test_strength_zero_returns_the_input_bits_with_gaps(walk):
    rotations = walk.rotations.copy()
    rotations[10:20, 3] = np.nan
    gapped = walk.with_poses(rotations)

    result = simulate(gapped, settings=SimulateSettings(strength=0.0))

    assert np.array_equal(result.motion.rotations, gapped.rotations, equal_nan=True)
    assert np.array_equal(result.motion.root_positions, gapped.root_positions)


def test_half_strength_is_halfway(walk, simulated):
    half = simulate(walk, settings=SimulateSettings(strength=0.5)).motion

    assert_allclose(
        half.root_positions,
        (walk.root_positions + simulated.motion.root_positions) / 2,
        atol=1e-9,
    )
    later = apply_strength(walk, simulated, 0.5)
    assert_allclose(np.abs((later.rotations * half.rotations).sum(axis=-1)), 1.0, atol=1e-9)
    assert np.array_equal(
        apply_strength(walk, simulated, 1.0).rotations, simulated.motion.rotations
    )
    assert np.array_equal(apply_strength(walk, simulated, 0.0).rotations, walk.rotations)


def test_root_bone_on_the_floor_moves_with_the_body(walk, simulated):
    """Hips with a parent are simulated as hips; the parent only moves."""
    floor = np.array([0.0, 0.0, 0.0])
    skeleton, hips = walk.skeleton, walk.rotations[:, :1]
    offsets = skeleton.offsets.copy()
    rigged = type(skeleton)(
        ("Armature", *skeleton.names),
        (-1, *(parent + 1 for parent in skeleton.parents)),
        np.concatenate([[floor], [[0.0, 0.0, 1.0]], offsets[1:]]),
    )
    rotation = quaternion_from_rotation_vector([0.0, 0.0, 0.4])
    still = np.tile(rotation, (walk.n_frames, 1, 1))
    back = multiply(rotation * (1, -1, -1, -1), hips)
    motion = Motion(
        rigged,
        np.concatenate([still, back, walk.rotations[:, 1:]], axis=1),
        walk.root_positions - (0.0, 0.0, 1.0),
        walk.frame_rate,
    )
    before = forward_kinematics(motion).positions[:, 1:]
    assert_allclose(before, forward_kinematics(walk).positions, atol=1e-9)

    result = simulate(motion).motion

    assert np.array_equal(result.rotations[:, 0], motion.rotations[:, 0])
    after = forward_kinematics(result).positions[:, 1:]
    differences = np.abs(after - forward_kinematics(simulated.motion).positions)
    assert differences.mean() < 0.002, "rounding may decide when a foot touches"


def raised(motion, height):
    return motion.with_poses(root_positions=motion.root_positions + np.array([0, 0, height]))


def distance(one, other):
    """Mean distance of the joints, meters."""
    positions, other_positions = (forward_kinematics(each).positions for each in (one, other))
    return float(np.linalg.norm(positions - other_positions, axis=-1).mean())


def jerk(motion):
    """Mean third derivative of the joint positions, m/s^3."""
    positions = forward_kinematics(motion).positions
    thirds = np.diff(positions, 3, axis=0) * motion.frame_rate**3
    return float(np.linalg.norm(thirds, axis=-1).mean())
