"""A cut is a lasting jump of the complete body; no movement of a body is one."""

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


def with_pose_outlier(motion, n_frames=1, angle=0.5):
    """Rotate every joint by up to 0.5 rad about a random axis."""
    directions = np.random.default_rng(7).normal(size=(motion.n_joints, 3))
    directions *= angle / np.linalg.norm(directions, axis=1, keepdims=True)
    rotations = multiply(motion.rotations[0], quaternion_from_rotation_vector(directions))
    ends = [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]
    rotations[ends] = IDENTITY
    return motion.with_poses(
        np.tile(rotations, (n_frames, 1, 1)), np.tile(motion.root_positions[:1], (n_frames, 1))
    )


@pytest.mark.parametrize("n_frames", [1, 2, 12])
def test_pose_outliers_are_found_at_both_ends(walk, n_frames):
    with_outlier = with_pose_outlier(walk, n_frames)

    assert find_shot_boundaries(joined(with_outlier, walk)) == (n_frames,)
    assert find_shot_boundaries(joined(walk, with_outlier)) == (walk.n_frames,)


def test_t_pose_that_faces_elsewhere_is_cut(walk):
    """The first frame of a suit: legs and spine stand as in the next one, arms do not."""
    rotations, roots = walk.rotations.copy(), walk.root_positions.copy()
    arms = [walk.skeleton.index(f"{side}{part}") for side in ("Left", "Right")
            for part in ("Shoulder", "Arm", "ForeArm", "Hand")]  # fmt: skip
    rotations[0], roots[0] = rotations[1], roots[1] + [0.1, 0.1, 0.0]
    rotations[0, arms] = quaternion_from_rotation_vector(np.array([1.2, 0.0, 0.0]))
    turn = quaternion_from_rotation_vector(np.array([0.0, 0.0, 1.5]))
    rotations[0, 0] = multiply(turn, rotations[0, 0])
    start = walk.with_poses(rotations, roots)

    assert find_shot_boundaries(start) == (1,)
    planted = plant_feet(denoise(start).recording).motion
    assert_array_equal(planted.rotations[0], rotations[0])
    turned = angle_between(planted.rotations[1:4], plant_feet(walk).motion.rotations[1:4])
    assert np.degrees(turned).max() < 4.0


def test_cut_is_found_in_tracks(walk):
    other = with_pose_outlier(walk, 30)
    positions = forward_kinematics(joined(walk, other)).positions
    tracks = Tracks(walk.skeleton.names, positions, walk.frame_rate)

    assert find_shot_boundaries(tracks) == (walk.n_frames,)


@pytest.mark.parametrize("n_frames", [1, 3, 8])
def test_transient_jump_of_a_body_is_no_cut(walk, n_frames):
    glitch = with_pose_outlier(walk.slice(60, 61), n_frames)

    assert not find_shot_boundaries(
        joined(walk.slice(0, 60), glitch, walk.slice(60 + n_frames, 180))
    )


def test_dropout_of_one_joint_is_no_cut(walk):
    rotations = walk.rotations.copy()
    rotations[40:90, 5] = np.nan
    rotations[90:, 5] = multiply(
        rotations[90:, 5], quaternion_from_rotation_vector([0, 0, 1.0])
    )

    assert not find_shot_boundaries(walk.with_poses(rotations))


@pytest.mark.parametrize("held", [2, 4])
def test_repeated_frames_are_no_cuts(walk, held):
    assert not find_shot_boundaries(
        walk.with_poses(
            np.repeat(walk.rotations[::held], held, axis=0),
            np.repeat(walk.root_positions[::held], held, axis=0),
        )
    )


@pytest.mark.parametrize(
    "corrupted",
    [
        CorruptionSettings(jitter=1.0),
        CorruptionSettings(jitter=7.0, spikes=0.4),
        CorruptionSettings(jitter=0.0, spikes=0.15),
        CorruptionSettings(jitter=0.0, spikes=0.3),
    ],
    ids=["noise", "noise and outliers", "outliers", "many outliers"],
)
def test_noise_is_no_cut(walk, corrupted):
    assert not find_shot_boundaries(corrupt(walk, corrupted))


def test_t_poses_of_real_recordings_are_cut_and_hops_are_not(recordings):
    for path in sorted((recordings / "mocap" / "cmu_hop").glob("*.bvh")):
        motion = read_bvh(path, scale=0.0254 / 0.45)
        thinned = Motion(
            motion.skeleton, motion.rotations[::4], motion.root_positions[::4], 30.0
        )
        assert find_shot_boundaries(motion) == find_shot_boundaries(thinned) == (1,), path.name
    for path in sorted((recordings / "mocap" / "hdm05").glob("*_001_120.amc")):
        assert not find_shot_boundaries(read_acclaim(path)), path.name


def test_pose_outlier_stays_and_does_not_affect_later_frames(walk):
    noisy = corrupt(walk, CorruptionSettings(jitter=0.5))
    take = joined(with_pose_outlier(walk), noisy)

    complete, separate = denoise(take), denoise(noisy)

    assert_array_equal(complete.recording.rotations[0], take.rotations[0])
    assert_allclose(complete.recording.rotations[1:], separate.recording.rotations, atol=1e-12)
    assert (
        complete.cuts == (1,)
        and not complete.outliers[0].any()
        and (complete.confidence[0] == 1).all()
    )
    assert complete.report().endswith("Frame 1 is a separate pose and was kept as recorded.")


def test_gaps_of_a_short_segment_are_filled(walk):
    take = joined(with_pose_outlier(walk, 3), walk)
    rotations = take.rotations.copy()
    rotations[1, 4] = np.nan

    cleaned = denoise(take.with_poses(rotations)).recording

    assert np.isfinite(cleaned.rotations).all()


def test_segments_of_a_joined_take_are_cleaned_separately(walk):
    noisy = corrupt(walk, CorruptionSettings(jitter=0.5))
    other = joined(*[with_pose_outlier(walk.slice(frame, frame + 1)) for frame in range(60)])

    cleaned = denoise(joined(noisy, other))

    assert cleaned.cuts == (walk.n_frames,)
    assert "cut before frame 181; its shots were cleaned separately" in cleaned.report()
    jump = angle_between(cleaned.recording.rotations[180], cleaned.recording.rotations[179])
    assert np.median(jump) > 0.3


def test_patterns_are_not_learned_across_a_cut(walk):
    plain, cut = (
        learn_filter_bases([walk]),
        learn_filter_bases([joined(with_pose_outlier(walk), walk)]),
    )

    assert_allclose(cut.slow, plain.slow, atol=1e-9)
    assert_allclose(cut.mean, plain.mean, atol=1e-9)


def test_cut_is_an_issue_and_no_spike(walk):
    take = joined(with_pose_outlier(walk), walk)
    take = take.with_poses(root_positions=take.root_positions + np.eye(1, 181).T)
    standing = np.ones((181, 2), dtype=bool)
    quality = measure_quality(take, contacts=standing)
    plain = measure_quality(walk, contacts=standing[1:])

    issues = find_worst_issues(take, quality)

    assert quality.cuts == (1,) and "cut before frame 2" in quality.report()
    assert quality.mean_jitter == pytest.approx(plain.mean_jitter)
    assert not quality.spikes.any()
    assert quality.feet[0].distance == pytest.approx(plain.feet[0].distance)
    assert [(issue.kind, issue.start_frame) for issue in issues if issue.kind == "cut"] == [
        ("cut", 0)
    ]


def test_feet_are_not_planted_across_a_cut(walk):
    take, separate = joined(with_pose_outlier(walk), walk), plant_feet(walk)

    planted = plant_feet(take)

    assert_array_equal(planted.motion.rotations[0], take.rotations[0])
    assert_allclose(
        planted.motion.root_positions[1:], separate.motion.root_positions, atol=1e-9
    )
    assert planted.slide_before == pytest.approx(separate.slide_before)


def test_message_has_the_numbers_of_the_frames(walk):
    take = joined(with_pose_outlier(walk, 2), walk, with_pose_outlier(walk, 60))

    assert describe_shots(take, (), range(242)) == ""
    assert describe_shots(take, (2, 182), range(1001, 1243)) == (
        "The take has a cut before frame 1183; its shots were cleaned separately."
        " Frames 1001 to 1002 are separate poses and were kept as recorded."
    )
    assert "before frame 91.5;" in describe_shots(take, (2, 182), 0.5 * np.arange(1, 243))


def test_reports_count_frames_from_one_or_as_the_timeline(walk):
    take = joined(with_pose_outlier(walk), walk)
    cleaned, quality = denoise(take), measure_quality(take)

    assert "Frame 1 is a separate pose" in cleaned.report()
    assert "Frame 0 is a separate pose" in cleaned.report(range(181))
    assert "cut before frame 2\n" in quality.report()
    assert "cut before frame 1\n" in quality.report(range(181))
