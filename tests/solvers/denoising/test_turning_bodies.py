"""Bodies and joints that make full turns, also below a bone above the hips."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.arrays import Array
from solvers.denoising import denoise
from solvers.denoising.channels import decode, encode
from solvers.denoising.channels.rotation_vectors import continuous_rotation_vectors
from solvers.denoising.channels.travel_path import UNWRAP_S, unwrap_angles
from solvers.motion import Motion, Skeleton, forward_kinematics
from solvers.rotations import (
    angle_between,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait
from solvers.signals import smoothstep

RATE = 30.0


@pytest.fixture(scope="module")
def spin() -> Motion:
    """A walk whose body makes two full turns within a second."""
    walk = walking_gait(GaitSettings(duration=3.0, frame_rate=RATE))
    rotation = about((0.0, 0.0, 1.0), 720.0 * smoothstep(np.arange(walk.n_frames), 30, 60))
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    return walk.with_poses(rotations, rotate(rotation, walk.root_positions))


def about(axis: tuple[float, float, float], degrees: Array) -> Array:
    return quaternion_from_rotation_vector(np.radians(degrees)[:, None] * axis)


def below_root_bone(motion: Motion, bone: Array) -> Motion:
    """Return the same motion of a rig with this rotation of a bone above the hips."""
    skeleton = motion.skeleton
    offsets = np.vstack([np.zeros(3), skeleton.offsets])
    offsets[1] = (0.3, 0.2, 0.9)
    rig = Skeleton(
        ("root", *skeleton.names), (-1, *(joint + 1 for joint in skeleton.parents)), offsets
    )
    bone = np.broadcast_to(bone, (motion.n_frames, 4))
    rotations = np.concatenate([bone[:, None], motion.rotations], axis=1)
    rotations[:, 1] = multiply(inverse(bone), motion.rotations[:, 0])
    roots = motion.root_positions - rotate(bone, offsets[1])
    return Motion(rig, rotations, roots, motion.frame_rate)


def max_angle(a: Array, b: Array) -> float:
    return float(np.degrees(np.nanmax(angle_between(a, b))))


def test_still_root_bone_changes_nothing(spin, rng):
    vectors = 0.03 * rng.normal(size=(*spin.rotations.shape[:2], 3))
    noise = quaternion_from_rotation_vector(vectors)
    noisy = spin.with_poses(multiply(spin.rotations, noise))
    rotations = noisy.rotations.copy()
    rotations[40:46, :3] = np.nan
    noisy = noisy.with_poses(rotations)
    bone = quaternion_from_rotation_vector([0.4, -0.2, 1.0])

    without, result = denoise(noisy), denoise(below_root_bone(noisy, bone))

    expected = forward_kinematics(without.recording)
    actual = forward_kinematics(result.recording)
    assert_allclose(actual.positions[:, 1:], expected.positions, atol=1e-9)
    assert max_angle(actual.rotations[:, 1:], expected.rotations) < 1e-5
    assert max_angle(actual.rotations[:, :1], bone) < 1e-5
    assert_allclose(result.confidence[:, 1:], without.confidence, atol=1e-9)


@pytest.mark.parametrize("bone", ["none", "still", "turns"])
def test_clean_spin_comes_back(spin, bone):
    heading = about((0.0, 0.0, 1.0), 720.0 * smoothstep(np.arange(spin.n_frames), 30, 60))
    still = quaternion_from_rotation_vector([0.4, -0.2, 1.0])
    motion = {
        "none": spin,
        "still": below_root_bone(spin, still),
        "turns": below_root_bone(spin, heading),
    }[bone]

    cleaned = denoise(motion).recording

    assert max_angle(cleaned.rotations, motion.rotations) < 0.3


@pytest.mark.parametrize("degrees", [200.0, 360.0, 1440.0])
def test_joint_that_turns_on_and_on_comes_back_through_its_channels(spin, degrees):
    rotations = spin.rotations.copy()
    arm = spin.skeleton.index("LeftArm")
    rotation = about((0.6, 0.0, 0.8), degrees * smoothstep(np.arange(spin.n_frames), 10, 80))
    rotations[:, arm] = multiply(rotations[:, arm], rotation)
    rotations[20:26, arm] = np.nan
    motion = spin.with_poses(rotations)

    channels = encode(motion)

    part = channels.keys.index("leftUpperArm")
    steps = np.linalg.norm(np.diff(channels.values[:, part], axis=0), axis=1)
    assert np.nanmax(steps) < 3.0 * max_angle(rotations[1:, arm], rotations[:-1, arm])
    back = decode(motion, channels, np.nan_to_num(channels.values))
    observed = motion.observed
    assert max_angle(back.rotations[observed], motion.rotations[observed]) < 1e-5


def test_somersault_is_continuous(spin):
    rotations = spin.rotations.copy()
    rotation = about((1.0, 0.0, 0.0), 360.0 * smoothstep(np.arange(spin.n_frames), 60, 85))
    rotations[:, 0] = multiply(rotations[:, 0], rotation)

    channels = encode(spin.with_poses(rotations))

    part = channels.keys.index("hips")
    assert np.linalg.norm(np.diff(channels.values[:, part], axis=0), axis=1).max() < 45.0


def test_spikes_do_not_add_up_to_turns():
    """Two spikes in a row lead around the circle: 100, 260, 420 and on to 460 degrees."""
    angles = np.full(60, 100.0)
    angles[30:32] = 260.0, 60.0
    rotations = about((0.0, 0.6, 0.8), angles)[:, None]
    rotations[10:15] = np.nan

    vectors, references = continuous_rotation_vectors(rotations, 120.0)
    unwrapped = np.degrees(unwrap_angles(np.radians(angles % 360.0), UNWRAP_S * 120.0))

    assert_allclose(vectors[-1, 0], vectors[0, 0], atol=1e-9)
    assert np.isnan(vectors[10:15]).all()
    assert not np.isnan(references).any()
    assert_allclose(unwrapped[-1], unwrapped[0], atol=1e-9)


def test_vectors_near_half_a_turn_do_not_jump(rng):
    """A joint that stands at half a turn from where it mostly is, with noise."""
    angles = 178.0 * smoothstep(np.arange(90), 50, 60)
    noise = quaternion_from_rotation_vector(0.05 * rng.normal(size=(90, 1, 3)))
    rotations = multiply(about((0.0, 0.0, 1.0), angles)[:, None], noise)

    vectors, _ = continuous_rotation_vectors(rotations, RATE)

    assert np.degrees(np.abs(np.diff(vectors, axis=0)).max()) < 60.0
