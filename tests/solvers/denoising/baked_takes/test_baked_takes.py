"""Takes that were recorded at a lower rate and interpolated to that of a scene."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import DenoiseSettings, denoise
from solvers.denoising.baked_takes import Baking, find_baking, recorded_samples
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.rotations import (
    angle_between,
    euler_from_quaternion,
    multiply,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    slerp,
)
from solvers.samples import GaitSettings, walking_gait

RATES = [
    (24, 30, (5, 4)),
    (25, 30, (6, 5)),
    (30, 60, (2, 1)),
    (24, 60, (5, 2)),
    (30, 120, (4, 1)),
]


def gait(rate: float) -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=rate))


def noisy(motion: Motion, degrees: float) -> Motion:
    vectors = np.random.default_rng(3).normal(size=(*motion.rotations.shape[:2], 3))
    noise = quaternion_from_rotation_vector(np.radians(degrees) * vectors)
    return motion.with_poses(multiply(motion.rotations, noise))


def between(values: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Interpolate linearly at these times, in samples."""
    low = np.minimum(times.astype(int), len(values) - 2)
    weight = (times - low).reshape(-1, *[1] * (values.ndim - 1))
    return values[low] + weight * (values[low + 1] - values[low])


def bake(motion: Motion, rate: float, by_euler: bool = False) -> Motion:
    """Interpolate each joint to this rate, as an editor does."""
    last = (motion.n_frames - 1) / motion.frame_rate
    times = np.arange(int(last * rate + 1e-9) + 1) / rate * motion.frame_rate
    low = np.minimum(times.astype(int), motion.n_frames - 2)
    if by_euler:
        angles = np.unwrap(euler_from_quaternion(motion.rotations, "ZXY"), axis=0)
        rotations = quaternion_from_euler(between(angles, times), "ZXY")
    else:
        first, second = motion.rotations[low], motion.rotations[low + 1]
        rotations = slerp(first, second, (times - low)[:, None])
    roots = between(motion.root_positions, times)
    return Motion(motion.skeleton, rotations, roots, rate)


def error(result: Motion, truth: Motion) -> float:
    return float(np.degrees(angle_between(result.rotations, truth.rotations)).mean())


@pytest.mark.parametrize("by_euler", [False, True])
@pytest.mark.parametrize("degrees", [0.05, 2.0])
@pytest.mark.parametrize(("recorded", "rate", "ratio"), RATES)
def test_rate_of_the_recording_is_found(recorded, rate, ratio, degrees, by_euler):
    baked = bake(noisy(gait(recorded), degrees), rate, by_euler)
    assert find_baking(baked) == Baking(*ratio, 0)


@pytest.mark.parametrize("degrees", [0.0, 0.02, 2.0])
@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0])
def test_smooth_movement_is_not_baked(rate, degrees):
    assert find_baking(noisy(gait(rate), degrees)) is None


def test_rounding_of_still_joints_is_no_baking():
    still = gait(60.0)
    still = still.with_poses(still.rotations[:1].repeat(90, 0), still.root_positions[:90] * 0.0)
    assert find_baking(bake(noisy(still, 1e-4), 120.0)) is None


def test_fingers_of_a_faster_glove_are_kept():
    """Half of the joints were recorded at each frame."""
    baked = bake(noisy(gait(30.0), 0.5), 60.0)
    own = noisy(gait(60.0), 0.5).rotations[: baked.n_frames]
    moving = np.flatnonzero(np.ptp(own, axis=0).max(axis=-1) > 1e-2)[::4]
    rotations = baked.rotations.copy()
    rotations[:, moving] = own[:, moving]
    assert find_baking(baked) is not None
    assert find_baking(baked.with_poses(rotations)) is None


def test_part_of_a_take_at_its_own_rate_is_kept():
    baked, own = bake(noisy(gait(30.0), 0.5), 60.0), noisy(gait(60.0), 0.5)
    rotations = np.concatenate([baked.rotations[:-32], own.rotations[-32:]])
    roots = np.concatenate([baked.root_positions[:-32], own.root_positions[-32:]])
    assert find_baking(replace(baked, rotations=rotations, root_positions=roots)) is None


@pytest.mark.parametrize(("recorded", "rate", "ratio"), RATES)
def test_samples_are_those_recorded(recorded, rate, ratio):
    motion = noisy(gait(recorded), 1.0)
    baked = bake(motion, rate)
    samples = recorded_samples(baked, Baking(*ratio, 0))
    assert samples.frame_rate == pytest.approx(recorded)
    n_frames = min(motion.n_frames, samples.n_frames) - 1
    turned = angle_between(samples.rotations[:n_frames], motion.rotations[:n_frames])
    assert np.degrees(turned).max() < 0.05
    assert_allclose(samples.root_positions[:n_frames], motion.root_positions[:n_frames])


def test_take_that_starts_between_two_samples():
    baked = bake(noisy(gait(30.0), 1.0), 60.0)
    later = baked.slice(1, baked.n_frames)
    assert find_baking(later) == Baking(2, 1, 1)
    assert denoise(later).recording.n_frames == later.n_frames


@pytest.mark.parametrize(("recorded", "rate", "ratio"), RATES)
def test_noise_that_was_interpolated_is_removed(recorded, rate, ratio):
    """It is as much as what is left of noise of each frame, at the rate of the recording."""
    baked = bake(noisy(gait(recorded), 2.0), rate)
    truth = gait(rate).slice(0, baked.n_frames)
    result = denoise(baked)
    assert result.recording.frame_rate == rate
    of_samples = denoise(noisy(gait(recorded), 2.0)).recording
    assert error(result.recording, truth) < 1.1 * error(of_samples, gait(recorded))
    assert result.prior_used.startswith(
        f"The take was recorded at {recorded} Hz and interpolated to {rate} Hz; it was cleaned"
        f" at {recorded} Hz."
    )


def test_missing_frames_are_filled():
    baked = bake(noisy(gait(30.0), 0.5), 60.0)
    arm = list(baked.skeleton.subtree(baked.skeleton.index("RightArm")))
    rotations = baked.rotations.copy()
    rotations[81:100, arm] = np.nan
    samples = recorded_samples(baked.with_poses(rotations), Baking(2, 1, 0))
    missing = np.flatnonzero(np.isnan(samples.rotations[:, arm[0], 0]))
    assert list(missing) == list(range(40, 51))
    result = denoise(baked.with_poses(rotations))
    assert np.isfinite(result.recording.rotations).all()
    assert error(result.recording, gait(60.0).slice(0, baked.n_frames)) < 1.0


def test_frames_that_were_dropped_before_are_filled_too():
    """The frame after them is a mixture of the repeated pose and of the next one."""
    motion = noisy(gait(30.0), 0.05)
    frames = np.arange(motion.n_frames)
    frames[40:45] = 39
    dropped = motion.with_poses(motion.rotations[frames], motion.root_positions[frames])
    baked = bake(dropped, 60.0)
    result = denoise(baked)
    assert result.held[79:90].any(axis=1).all()
    assert not result.held[:78].any()
    truth = gait(60.0).slice(79, 90)
    assert error(result.recording.slice(79, 90), truth) < error(baked.slice(79, 90), truth)


def test_cut_stays_where_it_was():
    one, other = noisy(gait(30.0), 0.3), noisy(gait(30.0), 0.3)
    turn = quaternion_from_rotation_vector(np.radians([40.0, 30.0, 70.0]))
    joined = replace(
        one,
        rotations=np.concatenate([one.rotations, multiply(turn, other.rotations)]),
        root_positions=np.concatenate([one.root_positions, other.root_positions + 3.0]),
    )
    baked = bake(joined, 60.0)
    result = denoise(baked)
    assert result.cuts == (2 * one.n_frames,)
    between_shots = 2 * one.n_frames - 1
    assert_allclose(
        result.recording.rotations[between_shots], baked.rotations[between_shots], atol=1e-9
    )


def test_nothing_changes_at_strength_0_and_half_at_one_half():
    baked = bake(noisy(gait(30.0), 2.0), 60.0)
    results = [
        denoise(baked, settings=DenoiseSettings(strength=strength)).recording
        for strength in (0.0, 0.5, 1.0)
    ]
    assert angle_between(results[0].rotations, baked.rotations).max() < 1e-7
    half, change = (angle_between(each.rotations, baked.rotations) for each in results[1:])
    assert_allclose(half, change / 2, atol=1e-6)


def test_points_are_cleaned_at_their_rate():
    motion = noisy(gait(30.0), 0.0)
    positions = forward_kinematics(motion).positions[:, 1:12]
    positions = positions + np.random.default_rng(1).normal(scale=0.01, size=positions.shape)
    times = np.arange(2 * len(positions) - 1) / 2.0
    tracks = Tracks(motion.skeleton.names[1:12], between(positions, times), 60.0)
    result = denoise(tracks)
    assert find_baking(tracks) == Baking(2, 1, 0)
    truth = forward_kinematics(gait(60.0)).positions[: tracks.n_frames, 1:12]
    assert np.abs(result.recording.positions - truth).mean() < 0.004
