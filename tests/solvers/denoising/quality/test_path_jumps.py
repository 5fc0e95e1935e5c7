"""A body that is put elsewhere in one frame is an issue; a body that leaps is none."""

import numpy as np
import pytest

from solvers.denoising import (
    DenoiseSettings,
    denoise,
    find_worst_issues,
    measure_quality,
    plant_feet,
)
from solvers.motion import Motion, forward_kinematics
from solvers.motion.humanoid import detect_contacts
from solvers.motion.skeletons import find_path_jumps
from solvers.recordings import read_acclaim
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module", params=[30.0, 120.0])
def walk(request) -> Motion:
    return walking_gait(GaitSettings(duration=2.0, frame_rate=request.param))


def displaced(motion: Motion, frames: slice, by: tuple[float, float, float]) -> Motion:
    positions = motion.root_positions.copy()
    positions[frames] += by
    return motion.with_poses(root_positions=positions)


def test_body_that_is_put_elsewhere_is_listed(walk):
    jump = displaced(walk, slice(40, None), (0.3, 0.0, 0.0))

    (found,) = find_path_jumps(jump, ())
    assert found.frame == 40
    assert found.distance == pytest.approx(0.3, abs=0.02)
    sentences = [issue.sentence for issue in find_worst_issues(jump)]
    assert "Hips jumps by 30 cm and stays there." in sentences


def test_such_a_jump_is_no_slide_and_hardly_jitter(walk):
    jump = displaced(walk, slice(40, None), (0.3, 0.0, 0.0))
    before, after = measure_quality(walk), measure_quality(jump)

    worst, *others = find_worst_issues(jump, after)
    assert worst.kind == "jump"
    assert all(each.severity < 0.2 * worst.severity for each in others), others
    assert after.longest_foot_slide == pytest.approx(before.longest_foot_slide, abs=0.02)
    assert after.position_noise == pytest.approx(before.position_noise, abs=0.002)


def test_figures_and_the_table_name_jumps_of_the_body_and_of_joints(walk):
    first, second = walk.n_frames // 3, 2 * walk.n_frames // 3
    jump = displaced(walk, slice(second, None), (0.3, 0.0, 0.0))
    arm = walk.skeleton.index("LeftArm")
    rotations = jump.rotations.copy()
    turn = quaternion_from_rotation_vector(np.radians([0.0, 0.0, 60.0]))
    rotations[first:, arm] = multiply(rotations[first:, arm], turn)
    quality = measure_quality(jump.with_poses(rotations))

    (body,), (joint,) = quality.figures()["body_jumps"], quality.figures()["joint_jumps"]
    assert (body["frame"], joint["frame"], joint["joint"]) == (second, first, "LeftArm")
    assert body["distance_cm"] == pytest.approx(30.0, abs=2.0)
    assert joint["angle_deg"] == pytest.approx(60.0, abs=6.0)
    assert (
        f"the body jumps by {body['distance_cm']:.0f} cm at frame {second + 1}"
        in quality.report()
    )
    assert "LeftArm jumps by" in quality.report()


def test_spike_and_noise_are_no_jumps_of_the_path(walk, rng):
    assert not find_path_jumps(displaced(walk, slice(40, 42), (0.3, 0.0, 0.0)), ())
    noise = rng.normal(scale=0.005, size=walk.root_positions.shape)
    shaken = walk.with_poses(root_positions=walk.root_positions + noise)
    assert not find_path_jumps(shaken, ())


def test_jump_is_found_among_noise_and_outliers_but_they_are_none(walk, rng):
    noise = rng.normal(scale=0.03, size=walk.root_positions.shape)
    are_outliers = rng.random(walk.n_frames) < 0.1
    noise[are_outliers] += rng.normal(scale=0.4, size=(are_outliers.sum(), 3))
    noisy = walk.with_poses(root_positions=walk.root_positions + noise)
    assert not find_path_jumps(noisy, ())
    half = walk.n_frames // 2
    jump = displaced(noisy, slice(half, None), (2.0, 0.0, 0.0))
    assert half in [each.frame for each in find_path_jumps(jump, ())]


def test_noise_of_one_half_makes_no_jumps(walk, rng):
    """The median over the take is that of the quiet part."""
    noise = rng.normal(scale=0.03, size=walk.root_positions.shape)
    noise[: round(0.6 * walk.n_frames)] *= 0.02
    assert not find_path_jumps(walk.with_poses(root_positions=walk.root_positions + noise), ())


def test_cut_is_no_jump_of_the_path(walk):
    assert not find_path_jumps(displaced(walk, slice(40, None), (0.3, 0.0, 0.0)), (40,))


@pytest.mark.parametrize("step", [1, 4])
def test_fast_bodies_make_no_jumps(recordings, step):
    for path in sorted((recordings / "mocap" / "hdm05").glob("*.amc"))[::10]:
        motion = read_acclaim(path)
        frames = slice(None, None, step)
        motion = Motion(
            motion.skeleton, motion.rotations[frames], motion.root_positions[frames],
            motion.frame_rate / step,
        )  # fmt: skip
        assert not find_path_jumps(motion, ()), path.name


def test_clean_and_plant_feet_put_the_body_elsewhere_as_it_is(walk, rng):
    """A fit across the jump bends the hips over by 50 cm at 120 Hz, and holds a foot behind."""
    vectors = np.radians(0.5) * rng.normal(size=(*walk.rotations.shape[:2], 3))
    noisy = walk.with_poses(multiply(walk.rotations, quaternion_from_rotation_vector(vectors)))
    frames, offset = slice(walk.n_frames // 2, None), (1.5, 0.5, 0.0)
    assert detect_contacts(noisy)[frames.start - 1 : frames.start + 1].all(axis=0).any()
    expected = plant_feet(denoise(noisy).recording).motion
    cleaned = denoise(displaced(noisy, frames, offset)).recording
    planted = plant_feet(cleaned).motion
    joints = forward_kinematics(displaced(expected, frames, offset)).positions
    assert np.abs(forward_kinematics(planted).positions - joints).max() < 0.03
    (jump,) = find_path_jumps(planted, ())
    assert jump.frame == frames.start


def test_strength_of_zero_keeps_a_body_that_is_put_elsewhere_to_the_last_bit(walk):
    jump = displaced(walk, slice(walk.n_frames // 2, None), (1.1, 0.7, 1e-3))
    kept = denoise(jump, settings=DenoiseSettings(strength=0.0)).recording
    assert np.array_equal(kept.root_positions, jump.root_positions)


def test_take_of_a_few_frames_is_accepted(walk):
    assert not find_path_jumps(walk.slice(0, 3), ())
    missing = walk.root_positions.copy()
    missing[30:40] = np.nan
    assert not find_path_jumps(walk.with_poses(root_positions=missing), ())
