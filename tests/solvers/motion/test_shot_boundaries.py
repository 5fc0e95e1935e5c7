"""A cut is where the whole body jumps for good; nothing that a body does is one."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import (
    denoise,
    find_worst_issues,
    learn_filter_bases,
    measure_quality,
    plant_feet,
)
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.motion.skeletons.shot_boundaries import describe_shots, find_shot_boundaries
from solvers.recordings import read_acclaim, read_bvh
from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))


def joined(*motions):
    return motions[0].with_poses(
        np.concatenate([motion.rotations for motion in motions]),
        np.concatenate([motion.root_positions for motion in motions]),
    )


def pose_apart(motion, n_frames=1, turn=0.5):
    """Every joint turned by up to 0.5 rad, about an axis of its own."""
    ways = np.random.default_rng(7).normal(size=(motion.n_joints, 3))
    ways *= turn / np.linalg.norm(ways, axis=1, keepdims=True)
    rotations = multiply(motion.rotations[0], quaternion_from_rotation_vector(ways))
    ends = [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]
    rotations[ends] = IDENTITY
    return motion.with_poses(
        np.tile(rotations, (n_frames, 1, 1)), np.tile(motion.root_positions[:1], (n_frames, 1))
    )


@pytest.mark.parametrize("n_frames", [1, 2, 12])
def test_a_pose_apart_is_found_at_either_end(walk, n_frames):
    apart = pose_apart(walk, n_frames)

    assert find_shot_boundaries(joined(apart, walk)) == (n_frames,)
    assert find_shot_boundaries(joined(walk, apart)) == (walk.n_frames,)


def test_a_join_is_found_in_tracks_too(walk):
    other = pose_apart(walk, 30)
    places = forward_kinematics(joined(walk, other)).positions
    tracks = Tracks(walk.skeleton.names, places, walk.frame_rate)

    assert find_shot_boundaries(tracks) == (walk.n_frames,)


@pytest.mark.parametrize("n_frames", [1, 3, 8])
def test_a_body_that_jumps_away_and_comes_back_is_not_cut(walk, n_frames):
    glitch = pose_apart(walk.slice(60, 61), n_frames)

    assert not find_shot_boundaries(
        joined(walk.slice(0, 60), glitch, walk.slice(60 + n_frames, 180))
    )


def test_one_joint_lost_and_found_is_no_cut(walk):
    rotations = walk.rotations.copy()
    rotations[40:90, 5] = np.nan
    rotations[90:, 5] = multiply(
        rotations[90:, 5], quaternion_from_rotation_vector([0, 0, 1.0])
    )

    assert not find_shot_boundaries(walk.with_poses(rotations))


@pytest.mark.parametrize("held", [2, 4])
def test_frames_that_are_repeated_are_no_cuts(walk, held):
    assert not find_shot_boundaries(
        walk.with_poses(
            np.repeat(walk.rotations[::held], held, axis=0),
            np.repeat(walk.root_positions[::held], held, axis=0),
        )
    )


@pytest.mark.parametrize(
    "spoilt",
    [
        CorruptionSettings(jitter=1.0),
        CorruptionSettings(jitter=7.0, spikes=0.4),
        CorruptionSettings(jitter=0.0, spikes=0.15),
        CorruptionSettings(jitter=0.0, spikes=0.3),
    ],
    ids=["noise", "noise and outliers", "outliers", "many outliers"],
)
def test_no_noise_makes_a_cut(walk, spoilt):
    assert not find_shot_boundaries(corrupt(walk, spoilt))


def test_t_poses_of_real_recordings_are_found_and_hops_are_not_cut(recordings):
    for path in sorted((recordings / "mocap" / "cmu_hop").glob("*.bvh")):
        motion = read_bvh(path, scale=0.0254 / 0.45)
        thinned = Motion(
            motion.skeleton, motion.rotations[::4], motion.root_positions[::4], 30.0
        )
        assert find_shot_boundaries(motion) == find_shot_boundaries(thinned) == (1,), path.name
    for path in sorted((recordings / "mocap" / "hdm05").glob("*_001_120.amc")):
        assert not find_shot_boundaries(read_acclaim(path)), path.name


def test_a_pose_apart_stays_and_does_not_touch_what_follows(walk):
    noisy = corrupt(walk, CorruptionSettings(jitter=0.5))
    take = joined(pose_apart(walk), noisy)

    whole, alone = denoise(take), denoise(noisy)

    assert_array_equal(whole.recording.rotations[0], take.rotations[0])
    assert_allclose(whole.recording.rotations[1:], alone.recording.rotations, atol=1e-12)
    assert (
        whole.cuts == (1,) and not whole.outliers[0].any() and (whole.confidence[0] == 1).all()
    )
    assert whole.prior_used.endswith("Frame 1 is a separate pose and was kept as recorded.")


def test_gaps_of_a_short_piece_are_filled(walk):
    take = joined(pose_apart(walk, 3), walk)
    rotations = take.rotations.copy()
    rotations[1, 4] = np.nan

    cleaned = denoise(take.with_poses(rotations)).recording

    assert np.isfinite(cleaned.rotations).all()


def test_pieces_of_a_joined_take_are_cleaned_apart(walk):
    noisy = corrupt(walk, CorruptionSettings(jitter=0.5))
    other = joined(*[pose_apart(walk.slice(frame, frame + 1)) for frame in range(60)])

    cleaned = denoise(joined(noisy, other))

    assert cleaned.cuts == (walk.n_frames,)
    assert "cut before frame 181; its shots were cleaned separately" in cleaned.prior_used
    jump = angle_between(cleaned.recording.rotations[180], cleaned.recording.rotations[179])
    assert np.median(jump) > 0.3


def test_patterns_are_not_learned_across_a_cut(walk):
    plain, cut = (
        learn_filter_bases([walk]),
        learn_filter_bases([joined(pose_apart(walk), walk)]),
    )

    assert_allclose(cut.slow, plain.slow, atol=1e-9)
    assert_allclose(cut.mean, plain.mean, atol=1e-9)


def test_the_jump_is_named_and_is_no_fault_of_the_body(walk):
    take = joined(pose_apart(walk), walk)
    take = take.with_poses(root_positions=take.root_positions + np.eye(1, 181).T)
    standing = np.ones((181, 2), dtype=bool)
    quality = measure_quality(take, contacts=standing)
    plain = measure_quality(walk, contacts=standing[1:])

    spots = find_worst_issues(take, quality)

    assert quality.cuts == (1,) and "cut before frame 2" in quality.report()
    assert quality.mean_jitter == pytest.approx(plain.mean_jitter)
    assert not quality.spikes.any()
    assert quality.feet[0].distance == pytest.approx(plain.feet[0].distance)
    assert [(spot.kind, spot.start_frame) for spot in spots if spot.kind == "cut"] == [
        ("cut", 0)
    ]


def test_feet_are_not_planted_across_a_cut(walk):
    take, alone = joined(pose_apart(walk), walk), plant_feet(walk)

    planted = plant_feet(take)

    assert_array_equal(planted.motion.rotations[0], take.rotations[0])
    assert_allclose(planted.motion.root_positions[1:], alone.motion.root_positions, atol=1e-9)
    assert planted.slide_before == pytest.approx(alone.slide_before)


def test_the_sentence_names_frames_from_one(walk):
    take = joined(pose_apart(walk, 2), walk, pose_apart(walk, 60))

    assert describe_shots(take, ()) == ""
    assert describe_shots(take, (2, 182)) == (
        "The take has a cut before frame 183; its shots were cleaned separately."
        " Frames 1 to 2 are separate poses and were kept as recorded."
    )
