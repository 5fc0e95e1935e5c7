"""Samples that a tracker repeated because it had lost a joint or the whole body."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    denoise,
    find_worst_issues,
    measure_quality,
)
from solvers.denoising.held_samples import find_held_samples
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.rotations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    slerp,
)
from solvers.samples import GaitSettings, walking_gait

LOST = slice(40, 56)


@pytest.fixture(scope="module")
def walk() -> Motion:
    """Three seconds at 30 Hz."""
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def arm(walk) -> list[int]:
    return list(walk.skeleton.subtree(walk.skeleton.index("RightArm")))


def hold(motion: Motion, frames: slice, joints: list[int]) -> Motion:
    """Repeat the rotations before these frames."""
    rotations = motion.rotations.copy()
    rotations[frames, joints] = rotations[frames.start - 1, joints]
    return motion.with_poses(rotations)


def repeat(motion: Motion, n: int) -> Motion:
    """Show every n-th frame n times."""
    frames = np.arange(motion.n_frames) // n * n
    return motion.with_poses(motion.rotations[frames], motion.root_positions[frames])


def noisy(motion: Motion, degrees: float) -> Motion:
    vectors = np.random.default_rng(3).normal(
        scale=np.radians(degrees), size=(*motion.rotations.shape[:2], 3)
    )
    return motion.with_poses(
        multiply(motion.rotations, quaternion_from_rotation_vector(vectors))
    )


def moving(motion: Motion) -> np.ndarray:
    return np.flatnonzero(np.ptp(motion.rotations, axis=0).max(axis=-1) > 1e-3)


@pytest.mark.parametrize("degrees", [0.0, 0.5])
def test_lost_arm_is_held_where_it_repeats(walk, arm, degrees):
    held = find_held_samples(hold(noisy(walk, degrees), LOST, arm))
    frames, parts = np.nonzero(held)
    assert set(frames) == set(range(LOST.start, LOST.stop))
    assert set(parts) <= set(arm)
    assert walk.skeleton.index("RightArm") in parts


@pytest.mark.parametrize("n", [2, 3])
def test_frames_shown_several_times_are_held(walk, n):
    held = find_held_samples(repeat(walk, n))[n:-n]
    body = held[:, moving(walk)].mean(axis=1)
    is_repeat = np.arange(n, walk.n_frames - n) % n != 0
    assert body[is_repeat].mean() > 0.7
    assert not body[~is_repeat].any()


def test_position_of_the_root_alone_is_held(walk):
    positions = walk.root_positions.copy()
    positions[LOST] = positions[LOST.start - 1]
    held = find_held_samples(walk.with_poses(root_positions=positions))
    assert held[LOST, -1].all()
    assert held.sum() == LOST.stop - LOST.start


def test_markers_that_repeat_are_held(walk):
    poses = forward_kinematics(walk)
    positions = poses.positions[:, moving(walk)].copy()
    positions[LOST, 2] = positions[LOST.start - 1, 2]
    names = tuple(walk.skeleton.names[joint] for joint in moving(walk))
    held = find_held_samples(Tracks(names, positions, walk.frame_rate))
    assert held[LOST, 2].all()
    assert held.sum() == LOST.stop - LOST.start


@pytest.mark.parametrize("degrees", [0.0, 1.0])
def test_nothing_is_held_in_a_movement(walk, degrees):
    assert not find_held_samples(noisy(walk, degrees)).any()


def test_pose_that_is_eased_into_and_out_of_is_not_held(walk):
    stop = np.concatenate([
        20 * (1 - (1 - np.linspace(0, 1, 21)) ** 2), np.full(20, 20.0),
        20 + 29 * np.linspace(0, 1, 30) ** 2,
    ])  # fmt: skip
    assert not find_held_samples(_at_times(walk, stop)).any()


def test_pose_between_linear_keys_is_not_held(walk):
    times = np.concatenate([np.arange(0, 30.0), np.full(20, 30.0), np.arange(30, 50.0)])
    keys = np.interp(times, [0, 30, 50], [0, 1, 2])
    poses = walk.rotations[[0, 20, 40]]
    low = np.minimum(keys.astype(int), 1)
    rotations = slerp(poses[low], poses[low + 1], (keys - low)[:, None])
    motion = replace(walk, rotations=rotations, root_positions=np.zeros((len(keys), 3)))
    assert not find_held_samples(motion).any()


def test_poses_keyed_on_steps_are_not_held(walk):
    assert not find_held_samples(repeat(walk, 8)).any()


def test_fingers_of_a_glove_in_coarse_steps_are_not_held(walk, arm):
    turns = 2.0 * np.round(8 * np.sin(np.arange(walk.n_frames) / 15.0))
    rotations = walk.rotations.copy()
    vectors = np.radians(turns)[:, None] * [1.0, 0.0, 0.0]
    rotations[:, arm[-2]] = quaternion_from_rotation_vector(vectors)
    assert not find_held_samples(walk.with_poses(rotations))[:, arm[-2]].any()


@pytest.mark.parametrize("drift", [0.0, 0.5])
def test_limit_at_which_a_joint_stops_again_and_again_is_not_held(walk, arm, drift):
    """A knee that sticks when it is straight, and then jumps; with drift no value recurs."""
    cycle = [40, 34, 28, 22, 16, 10, 5, 0, 0, 0, 0, 0, 0, 15, 22, 29, 36, 42, 46, 48, 47, 44]
    angles = np.resize(cycle, walk.n_frames).astype(float)
    angles += drift * (np.arange(walk.n_frames) // len(cycle))
    rotations = walk.rotations.copy()
    vectors = np.radians(angles)[:, None] * [1.0, 0.0, 0.0]
    rotations[:, arm[1]] = quaternion_from_rotation_vector(vectors)
    held = find_held_samples(walk.with_poses(rotations))[:, arm[1]]
    assert held.any() == (drift > 0.0)


def test_repeats_of_a_body_that_hardly_moves_do_not_matter(walk):
    slow = slerp(walk.rotations[:1], walk.rotations, np.full((1, 1), 0.005))
    roots = walk.root_positions * 0.001
    assert not find_held_samples(repeat(walk.with_poses(slow, roots), 2)).any()


def test_still_pose_at_the_start_or_before_a_cut_is_not_held(walk):
    still = np.concatenate([np.full(15, 10), np.arange(30, 60)])
    assert not find_held_samples(_frames(walk, still)).any()
    easing = 20 * (1 - (1 - np.linspace(0, 1, 41)) ** 4)
    times = np.concatenate([easing, np.full(10, 20.0), np.arange(53, 80.0)])
    assert not find_held_samples(_at_times(walk, times)).any()


def test_clean_moves_a_lost_arm_on(walk, arm):
    held = hold(walk, LOST, arm)
    result = denoise(held)
    assert result.held[LOST, arm[0]].all()
    assert "In 16 frames the tracker repeated earlier ones" in result.prior_used
    before, after = (
        np.degrees(angle_between(each.rotations, walk.rotations))[LOST, arm].mean()
        for each in (held, result.recording)
    )
    assert after < 0.5 * before
    assert result.confidence[LOST, arm[0]].min() < result.confidence[:30, arm[0]].min()


def test_strength_blends_what_was_held(walk, arm):
    held = hold(walk, LOST, arm)
    full, half, none = (
        denoise(held, settings=DenoiseSettings(strength_arms=each)).recording
        for each in (1.0, 0.5, 0.0)
    )
    assert angle_between(none.rotations, held.rotations)[:, arm[0]].max() < 1e-7
    steps = np.abs(angle_between(half.rotations, held.rotations))[LOST, arm[0]]
    at_full = np.abs(angle_between(full.rotations, held.rotations))[LOST, arm[0]]
    np.testing.assert_allclose(steps, 0.5 * at_full, atol=np.radians(0.05))


def test_published_method_takes_repeats_as_they_are(walk, arm):
    settings = DenoiseSettings(method=DenoiseMethod.PUBLISHED)
    assert not denoise(hold(walk, LOST, arm), settings=settings).held.any()


def test_dropped_frames_are_no_cut(walk):
    """The body jumps after four repeats, as it does between two joined takes."""
    frames = np.arange(walk.n_frames)
    frames[30:34] = 29
    result = denoise(_frames(walk, frames))
    assert result.cuts == ()
    assert result.held[30:34].any(axis=1).all()


def test_check_lists_the_arm_that_stands_still_and_the_body(walk, arm):
    lost = hold(walk, LOST, arm)
    issues = find_worst_issues(lost, measure_quality(lost))
    sentences = {each.joint: each.sentence for each in issues if each.kind == "gap"}
    assert sentences["RightArm"] == "RightArm stands still for 0.53 s and then jumps."
    frames = np.arange(walk.n_frames)
    frames[30:34] = 29
    dropped = _frames(walk, frames)
    (gap,) = (each for each in find_worst_issues(dropped) if each.kind == "gap")
    assert (gap.start_frame, gap.stop_frame) == (30, 34)
    assert gap.sentence == "The entire body stands still for 0.13 s and then jumps."


def _frames(motion: Motion, frames: np.ndarray) -> Motion:
    return replace(
        motion,
        rotations=motion.rotations[frames],
        root_positions=motion.root_positions[frames],
    )


def _at_times(motion: Motion, times: np.ndarray) -> Motion:
    """Play a motion at these times, in frames."""
    low = np.minimum(times.astype(int), motion.n_frames - 2)
    weight = times - low
    roots = motion.root_positions
    return replace(
        motion,
        rotations=slerp(motion.rotations[low], motion.rotations[low + 1], weight[:, None]),
        root_positions=roots[low] + weight[:, None] * (roots[low + 1] - roots[low]),
    )
