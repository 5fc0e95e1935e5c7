"""A cleaned recording must be complete, close to the truth, and report its prior."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    denoise,
    learn_filter_bases,
    learn_joint_limits,
    limit_excess,
    load_filter_bases,
)
from solvers.motion import Motion, Skeleton, Tracks
from solvers.recordings import read_bvh
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

WALKS = ("32_01", "07_01", "07_02", "07_04", "10_04")  # the take, then its examples


@pytest.mark.parametrize("method", DenoiseMethod)
@pytest.mark.parametrize("with_examples", [True, False])
def test_removes_most_of_the_noise(swinging_leg, rng, method, with_examples):
    bases = learn_filter_bases([swinging_leg]) if with_examples else None
    noisy = shaken(swinging_leg, rng, np.radians(3))

    result = denoise(noisy, bases, settings=DenoiseSettings(method=method))

    before = angle_between(noisy.rotations, swinging_leg.rotations)[:, :3].mean()
    after = angle_between(result.recording.rotations, swinging_leg.rotations)[:, :3].mean()
    # Without examples the published method keeps 99 % of a noisy take: mostly its noise.
    is_kept = method is DenoiseMethod.PUBLISHED and not with_examples
    assert after < (0.95 if is_kept else 0.6) * before


@pytest.mark.parametrize("method", DenoiseMethod)
def test_fills_every_gap_with_low_confidence(swinging_leg, rng, method):
    noisy = shaken(swinging_leg, rng, np.radians(1))
    noisy.rotations[30:50, 1] = np.nan
    noisy.root_positions[70:80] = np.nan

    result = denoise(noisy, settings=DenoiseSettings(method=method))

    assert result.recording.observed.all()
    assert result.confidence[40, 1] < result.confidence[10, 1]


def test_bases_are_unchanged_after_saving_and_loading(swinging_leg, tmp_path):
    bases = learn_filter_bases([swinging_leg])

    bases.save(tmp_path / "walk.bases.npz")

    assert_allclose(load_filter_bases(tmp_path / "walk.bases.npz").vectors, bases.vectors)


@pytest.mark.parametrize("n_frames", [1, 2, 3, 7, 30])
def test_shortest_takes_are_complete(swinging_leg, n_frames):
    short = swinging_leg.slice(0, n_frames)

    assert denoise(short).recording.observed.all()


def test_removes_noise_from_points(swinging_leg, rng):
    time = np.arange(90) / 30.0
    truth = np.stack([0.1 * np.sin(6 * time), -time, 1 + 0.05 * np.cos(6 * time)], axis=-1)
    truth = truth[:, None] + np.array([[0.0, 0, 0], [0.2, 0, 0.1], [0, 0.1, 0.3]])
    noisy = Tracks(("a", "b", "c"), truth + rng.normal(scale=0.01, size=truth.shape), 30.0)
    noisy.positions[20:30, 1] = np.nan

    cleaned = denoise(noisy).recording.positions

    observed = noisy.visible
    assert (
        np.abs(cleaned - truth)[observed].mean()
        < 0.7 * np.abs(noisy.positions - truth)[observed].mean()
    )
    assert np.isfinite(cleaned).all()


def shaken(motion: Motion, rng: np.random.Generator, scale: float, n_still: int = 1) -> Motion:
    """Return the motion with rotation noise of this standard deviation, radians."""
    vectors = rng.normal(scale=scale, size=(motion.n_frames, motion.n_joints, 3))
    vectors[:, motion.n_joints - n_still :] = 0.0
    noise = quaternion_from_rotation_vector(vectors)
    return motion.with_poses(multiply(motion.rotations, noise))


def test_examples_of_another_movement_are_rejected(swinging_leg):
    """The error is on average at most 10 % larger than without examples."""
    time = np.arange(240) / 60.0
    vectors = np.zeros((240, 4, 3))
    vectors[:, :3] = 1.2 * np.sin(time[:, None, None] * np.array([[11.0], [23.0], [17.0]]))
    frantic = Motion(
        swinging_leg.skeleton,
        quaternion_from_rotation_vector(vectors),
        np.tile([0.0, 0.0, 0.9], (240, 1)),
        60.0,
    )
    bases = learn_filter_bases([frantic])
    seeds = map(np.random.default_rng, range(5))
    takes = [shaken(swinging_leg, seed, np.radians(3)) for seed in seeds]

    wrong = [error(denoise(noisy, bases), swinging_leg) for noisy in takes]
    without = [error(denoise(noisy), swinging_leg) for noisy in takes]

    assert np.mean(wrong) < 1.1 * np.mean(without)


def test_strength_zero_fills_gaps_and_changes_nothing_else(swinging_leg, rng):
    noisy = shaken(swinging_leg, rng, np.radians(2))
    noisy.rotations[30:50, 1] = np.nan
    observed = np.isfinite(noisy.rotations)

    cleaned = denoise(noisy, settings=DenoiseSettings(strength=0.0)).recording

    assert np.array_equal(cleaned.rotations[observed], noisy.rotations[observed])
    assert cleaned.observed.all()


def test_finds_the_spikes(swinging_leg, rng):
    noisy = shaken(swinging_leg, rng, np.radians(1))
    spikes = [20, 57, 58, 90]
    spike = quaternion_from_rotation_vector([np.radians(40), 0.0, 0.0])
    noisy.rotations[spikes, 1] = multiply(noisy.rotations[spikes, 1], spike)

    result = denoise(noisy)

    assert np.flatnonzero(result.outliers[:, 1]).tolist() == spikes
    assert error(result, swinging_leg) < np.radians(1)


@pytest.mark.parametrize("frame_rate", [10.0, 24.0, 25.0, 50.0])
def test_removes_noise_at_any_frame_rate(swinging_leg, rng, frame_rate):
    take = Motion(
        swinging_leg.skeleton,
        swinging_leg.rotations,
        swinging_leg.root_positions,
        frame_rate,
    )

    result = denoise(shaken(take, rng, np.radians(2)), learn_filter_bases([take]))

    assert result.recording.n_frames == take.n_frames
    assert error(result, take) < np.radians(2)


def test_beats_the_published_filter_on_a_real_walk(recordings, rng):
    clips = [real_walk(recordings, name) for name in WALKS]
    truth = clips[0]
    bases = learn_filter_bases(clips[1:])
    noisy = shaken(truth, rng, np.radians(3), n_still=0)

    result = error(denoise(noisy, bases), truth)
    published_settings = DenoiseSettings(method=DenoiseMethod.PUBLISHED)

    assert result < 0.9 * error(denoise(noisy, bases, settings=published_settings), truth)
    assert (
        result < 0.6 * angle_between(noisy.rotations, truth.rotations)[:, moving(truth)].mean()
    )


def test_limb_wrong_for_a_fifth_of_a_second_is_corrected(recordings, rng):
    """Adjacent frames agree with the error; other limbs and distant frames do not."""
    clips = [real_walk(recordings, name) for name in WALKS]
    truth, bases = clips[0], learn_filter_bases(clips[1:])
    noisy = shaken(truth, rng, np.radians(3), n_still=0)
    is_wrong = np.zeros(noisy.rotations.shape[:2], dtype=bool)
    names = ("LeftForeArm", "RightArm", "LeftArm", "LeftLeg")
    for start, name in zip((20, 40, 60, 80), names, strict=True):
        is_wrong[start : start + 6, noisy.skeleton.index(name)] = True
    rotation = quaternion_from_rotation_vector([0.5, -0.5, 0.5])
    noisy.rotations[is_wrong] = multiply(rotation, noisy.rotations[is_wrong])

    result = denoise(noisy, bases)

    assert result.outliers[is_wrong].mean() > 0.9
    before, after = (
        angle_between(take.rotations, truth.rotations)[is_wrong].mean()
        for take in (noisy, result.recording)
    )
    assert after < 0.3 * before


def test_wrong_limb_is_detected_from_the_other_limbs(rng):
    """The same on a body of two independent rhythms and seven limbs."""
    mix = rng.normal(size=(2, 7, 3, 2))
    bases = learn_filter_bases([dancer(mix, seed) for seed in range(6)])
    truth = dancer(mix, 6)
    noisy = shaken(truth, rng, np.radians(1), n_still=0)
    is_wrong = np.zeros((truth.n_frames, 7), dtype=bool)
    is_wrong[30:36, 2] = is_wrong[60:66, 4] = is_wrong[90:95, 5] = True
    rotation = quaternion_from_rotation_vector([0.5, -0.5, 0.5])
    noisy.rotations[is_wrong] = multiply(rotation, noisy.rotations[is_wrong])

    result = denoise(noisy, bases)

    assert result.outliers[is_wrong].all()
    assert result.outliers[~is_wrong].mean() < 0.02
    after = angle_between(result.recording.rotations, truth.rotations)[is_wrong]
    assert after.max() < 0.2 * np.linalg.norm([0.5, 0.5, 0.5])


def dancer(mix, seed: int) -> Motion:
    """Return seven joints whose rotations mix two rhythms, with phases of their own."""
    names = tuple(f"limb {index}" for index in range(7))
    offsets = np.tile([0.0, 0.0, 0.3], (7, 1))
    skeleton = Skeleton(names, (-1, 0, 1, 2, 0, 4, 5), offsets)
    phases = np.random.default_rng(seed).uniform(0.0, 2 * np.pi, size=2)
    angles = 2 * np.pi * np.arange(120)[:, None] / 30.0 * [0.7, 1.1] + phases
    waves = np.stack([np.sin(angles), np.cos(angles)])
    vectors = 0.15 * np.einsum("wtr,wjar->tja", waves, mix)
    return Motion(skeleton, quaternion_from_rotation_vector(vectors), np.zeros((120, 3)), 30.0)


def test_repeated_fast_motion_is_no_outlier(rng):
    """The examples contain no waving."""
    mix = rng.normal(size=(2, 7, 3, 2))
    bases = learn_filter_bases([dancer(mix, seed) for seed in range(6)])
    plain = dancer(mix, 6)
    waving_angles = np.zeros((plain.n_frames, 7, 3))
    waving_angles[:, 3, 0] = 0.7 * np.sin(2 * np.pi * 2.5 * np.arange(plain.n_frames) / 30.0)
    waving_motion = plain.with_poses(
        multiply(plain.rotations, quaternion_from_rotation_vector(waving_angles)),
        plain.root_positions,
    )

    result = denoise(shaken(waving_motion, rng, np.radians(1), n_still=0), bases)

    assert result.outliers[:, 3].mean() < 0.1
    remaining_error = angle_between(result.recording.rotations, waving_motion.rotations)[:, 3]
    assert remaining_error.mean() < np.radians(2)


def test_knee_bent_forwards_is_corrected_with_limits(swinging_leg, rng):
    """The patterns of a swinging leg could follow it; its limits exclude it."""
    bases, limits = learn_filter_bases([swinging_leg]), learn_joint_limits([swinging_leg])
    noisy = shaken(swinging_leg, rng, np.radians(1))
    forwards = quaternion_from_rotation_vector(np.tile([1.2, 0.0, 0.0], (36, 1)))
    noisy.rotations[50:86, 1] = multiply(forwards, noisy.rotations[50:86, 1])

    without_limits, with_limits = denoise(noisy, bases), denoise(noisy, bases, limits=limits)

    assert limit_excess(with_limits.recording, limits).max() < np.radians(5.0)
    assert with_limits.outliers[50:86, 1].mean() > 2 * without_limits.outliers[50:86, 1].mean()
    assert error(with_limits, swinging_leg) < 0.9 * error(without_limits, swinging_leg)


def test_limits_of_another_body_remove_no_samples(swinging_leg, rng):
    limits = learn_joint_limits([swinging_leg])
    other = replace(limits, lower=limits.lower + 1.5, upper=limits.upper + 1.5)
    noisy = shaken(swinging_leg, rng, np.radians(1))

    assert not denoise(noisy, learn_filter_bases([swinging_leg]), limits=other).outliers.any()


def moving(motion: Motion) -> list[int]:
    return [j for j in range(motion.n_joints) if not motion.skeleton.is_end_site(j)]


def error(result, truth: Motion) -> float:
    """Return the mean angle to the truth, radians, over all joints that rotate."""
    angles = angle_between(result.recording.rotations, truth.rotations)
    return float(angles[:, moving(truth)].mean())


def real_walk(recordings, name: str) -> Motion:
    """Return a CMU walk at 30 Hz, without the T-pose of its first frame."""
    walk = read_bvh(recordings / "mocap" / "cmu_walk" / f"{name}.bvh")
    return Motion(walk.skeleton, walk.rotations[1::4], walk.root_positions[1::4], 30.0)


def test_limb_never_observed_has_low_confidence():
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    rotations = walk.rotations.copy()
    arm = walk.skeleton.subtree(walk.skeleton.index("LeftArm"))
    rotations[:, arm] = np.nan

    result = denoise(walk.with_poses(rotations, walk.root_positions))

    joints = [joint for joint in arm if not walk.skeleton.is_end_site(joint)]
    assert (result.confidence[:, joints] < 0.2).all()
    assert result.confidence.mean() > 0.5


def test_all_frames_are_filled_at_two_frames_per_second(rng):
    positions = rng.normal(size=(40, 3, 3))
    positions[10:20, 0] = np.nan

    result = denoise(Tracks(("a", "b", "c"), positions, 2.0))

    assert np.isfinite(result.recording.positions).all()
    assert np.isfinite(result.confidence).all()
