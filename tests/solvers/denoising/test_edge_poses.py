"""A limb that starts or ends in a separate pose does not disturb the rest of the take."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import denoise
from solvers.denoising.edge_poses import find_edge_poses
from solvers.motion import Motion
from solvers.recordings import read_recording
from solvers.rotations import (
    IDENTITY,
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


def noisy(motion: Motion, degrees: float, rng: np.random.Generator) -> Motion:
    vectors = np.radians(degrees) * rng.normal(size=(*motion.rotations.shape[:2], 3))
    noise = quaternion_from_rotation_vector(vectors)
    return motion.with_poses(multiply(motion.rotations, noise))


def with_arm_in_t_pose(motion: Motion, frames: slice) -> Motion:
    rotations = motion.rotations.copy()
    arm = list(motion.skeleton.subtree(motion.skeleton.index("LeftArm")))
    rotations[frames, arm] = IDENTITY
    return motion.with_poses(rotations)


@pytest.mark.parametrize(
    ("frames", "text"),
    [
        (slice(0, 1), "Frame 1 of the left arm is a separate pose"),
        (slice(0, 3), "Frames 1 to 3 of the left arm are separate poses"),
        (slice(86, 90), "Frames 87 to 90 of the left arm are separate poses"),
    ],
)
def test_arm_in_t_pose_at_an_end_changes_no_other_sample(walk, rng, frames, text):
    moving = noisy(walk, 1.0, rng)
    rotations = moving.rotations.copy()
    arm = list(walk.skeleton.subtree(walk.skeleton.index("LeftShoulder")))
    rotations[frames, arm] = np.nan
    without = denoise(moving.with_poses(rotations)).recording
    given = with_arm_in_t_pose(moving, frames)

    result = denoise(given)

    kept = np.zeros(walk.rotations.shape[:2], dtype=bool)
    kept[frames, np.array(arm)[:, None]] = True
    assert (result.recording.rotations[kept] == given.rotations[kept]).all()
    assert (result.confidence[kept] == 1.0).all()
    assert not result.outliers[kept].any()
    assert angle_between(result.recording.rotations, without.rotations)[~kept].max() < 1e-6
    assert text in result.report()


@pytest.mark.parametrize(("joint", "name"), [("Hips", "hips"), ("Neck", "head")])
def test_first_frame_that_faces_elsewhere_changes_no_other_sample(walk, rng, joint, name):
    """Suits begin with a T-pose that faces north; streams with a head that looks ahead."""
    moving = noisy(walk, 1.0, rng)
    rotations, roots = moving.rotations.copy(), moving.root_positions.copy()
    index = walk.skeleton.index(joint)
    turn = quaternion_from_rotation_vector(np.radians(90.0) * np.array([0.0, 0.0, 1.0]))
    rotations[0, index] = multiply(turn, rotations[0, index])
    if index == 0:
        roots[0, 0] += 0.5

    result = denoise(moving.with_poses(rotations, roots))

    cleaned = result.recording
    assert f"Frame 1 of the {name} is a separate pose" in result.report()
    assert angle_between(cleaned.rotations[0, index], rotations[0, index]) < 1e-6
    if index == 0:
        np.testing.assert_array_equal(cleaned.root_positions[0], roots[0])
    errors = np.degrees(angle_between(cleaned.rotations[1:], walk.rotations[1:]))
    assert errors[:10, index].max() < 3.0
    assert np.abs(cleaned.root_positions[1:] - walk.root_positions[1:]).max() < 0.03


def test_real_movement_is_not_classified_as_an_edge_pose(walk, rng):
    """A punch at the very start: the elbow extends by 100 degrees within four frames."""
    time = np.arange(-2, walk.n_frames - 2)
    angles = np.radians(50.0) * np.tanh(time / 1.0)
    rotations = walk.rotations.copy()
    punch = quaternion_from_rotation_vector(angles[:, None] * (0.0, 0.0, 1.0))
    rotations[:, walk.skeleton.index("LeftForeArm")] = punch
    motion = walk.with_poses(rotations)

    for start in range(4):
        assert not find_edge_poses(motion.slice(start, motion.n_frames), ())
    assert not find_edge_poses(noisy(motion, 3.0, rng), ())


@pytest.mark.parametrize(
    "take", ["kickLFront1Reps_001", "hopBothLegs1hops_002", "jogLeftCircle4StepsRstart_001"]
)
@pytest.mark.parametrize("step", [1, 4])
def test_recorded_takes_begin_anywhere(recordings, take, step):
    motion = read_recording(recordings / f"mocap/hdm05/HDM_bd_{take}_120.amc")
    assert isinstance(motion, Motion)
    rotations, roots = motion.rotations[::step], motion.root_positions[::step]
    motion = Motion(motion.skeleton, rotations, roots, motion.frame_rate / step)

    for start in range(0, motion.n_frames - int(motion.frame_rate), 3):
        part = motion.slice(start, motion.n_frames)
        assert not find_edge_poses(part, ())


def test_take_that_begins_as_a_quick_turn_ends_has_no_edge_pose(walk):
    """Its only step of 45 degrees has no step before it that would predict it."""
    rotations = walk.rotations.copy()
    elbow, rotation = walk.skeleton.index("LeftForeArm"), np.array([0.0, 0.0, np.radians(45.0)])
    rotations[0, elbow] = multiply(
        rotations[1, elbow], quaternion_from_rotation_vector(rotation)
    )

    assert not find_edge_poses(walk.with_poses(rotations), ())


def test_spike_near_the_start_is_no_edge_pose(walk):
    assert not find_edge_poses(with_arm_in_t_pose(walk, slice(2, 5)), ())


def test_gaps_and_short_takes_are_accepted(walk):
    rotations = walk.rotations.copy()
    rotations[:5] = np.nan

    assert not find_edge_poses(walk.with_poses(rotations), ())
    for n_frames in (1, 2, 3, 9):
        assert not find_edge_poses(walk.slice(0, n_frames), ())


def test_take_shorter_than_its_ends_has_no_separate_pose(walk):
    """60 frames at 240 Hz: a quarter of a second has more steps than the take."""
    short = replace(walk.slice(0, 60), frame_rate=240.0)

    assert denoise(short).recording.observed.all()


@pytest.mark.parametrize("rate", [1.0, 2.0, 4.0])
def test_poses_with_seconds_between_them_are_kept(recordings, rate):
    """They were turned by up to 28 degrees, though nothing in the walk is noise."""
    walk = read_recording(recordings / "mocap" / "cmu_walk" / "07_01.bvh")
    walk = walk.slice(1, walk.n_frames)
    step = round(walk.frame_rate / rate)
    every = slice(None, None, step)
    poses = Motion(walk.skeleton, walk.rotations[every], walk.root_positions[every], rate)

    result = denoise(poses).recording

    assert angle_between(result.rotations, poses.rotations).max() < 1e-6
    assert_allclose(result.root_positions, poses.root_positions, atol=1e-9)
