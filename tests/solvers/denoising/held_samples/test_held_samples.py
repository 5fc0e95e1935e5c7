"""Samples that a tracker repeated because it had lost a joint or the whole body."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.denoising import denoise, find_worst_issues, measure_quality
from solvers.denoising.held_samples import find_held_samples
from solvers.motion import Motion, Tracks, forward_kinematics
from solvers.recordings import read_recording
from solvers.rotations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
    slerp,
)
from solvers.samples import GaitSettings, walking_gait

LOST = slice(40, 56)


def in_frames(motion: Motion, frames: np.ndarray) -> Motion:
    """Show these frames one after the other."""
    rotations, roots = motion.rotations[frames], motion.root_positions[frames]
    return replace(motion, rotations=rotations, root_positions=roots)


def repeat(motion: Motion, n: int) -> Motion:
    """Show every n-th frame n times."""
    return in_frames(motion, np.arange(motion.n_frames) // n * n)


def without_four_frames(motion: Motion) -> Motion:
    frames = np.arange(motion.n_frames)
    frames[30:34] = 29
    return in_frames(motion, frames)


def at_times(motion: Motion, times: np.ndarray) -> Motion:
    """Play a motion at these times, in frames."""
    low = np.minimum(times.astype(int), motion.n_frames - 2)
    weight = times - low
    roots = motion.root_positions
    return replace(
        motion,
        rotations=slerp(motion.rotations[low], motion.rotations[low + 1], weight[:, None]),
        root_positions=roots[low] + weight[:, None] * (roots[low + 1] - roots[low]),
    )


def with_elbow(motion: Motion, degrees: np.ndarray) -> tuple[Motion, int]:
    """Return the motion with one joint that has these angles, and the joint."""
    elbow = motion.skeleton.index("RightForeArm")
    rotations = motion.rotations.copy()
    vectors = np.radians(degrees)[:, None] * [1.0, 0.0, 0.0]
    rotations[:, elbow] = quaternion_from_rotation_vector(vectors)
    return motion.with_poses(rotations), elbow


def moving(motion: Motion) -> np.ndarray:
    return np.flatnonzero(np.ptp(motion.rotations, axis=0).max(axis=-1) > 1e-2)


@pytest.mark.parametrize("degrees", [0.0, 0.5, 3.0])
def test_lost_arm_is_held_where_it_repeats(walk, arm, degrees, hold, add_jitter):
    frames, parts = np.nonzero(find_held_samples(hold(add_jitter(walk, degrees), LOST, arm)))
    assert set(frames) == set(range(LOST.start, LOST.stop))
    assert arm[0] in parts
    assert set(parts) <= set(arm)


def test_hand_of_a_lost_arm_is_held_though_its_forearm_was_never_observed(
    walk, arm, hold, add_jitter
):
    motion = hold(add_jitter(walk, 0.5), LOST, arm)
    rotations = motion.rotations.copy()
    rotations[:, arm[1]] = np.nan
    held = find_held_samples(walk.with_poses(rotations))
    assert held[LOST.start + 1 : LOST.stop, [arm[0], arm[2]]].all()


def test_arm_that_a_tracker_puts_into_its_rest_pose_is_held_from_the_first_frame_on(
    walk, arm, add_jitter
):
    rotations = add_jitter(walk, 0.3).rotations.copy()
    rotations[LOST, arm[:3]] = [1.0, 0.0, 0.0, 0.0]
    held = find_held_samples(walk.with_poses(rotations))
    assert held[LOST, arm[0]].all()
    assert not np.delete(held, range(LOST.start, LOST.stop), axis=0).any()


@pytest.mark.parametrize("n", [2, 3])
def test_frames_shown_several_times_are_held(walk, n):
    held = find_held_samples(repeat(walk, n))[n:-n]
    body = held[:, moving(walk)].mean(axis=1)
    is_repeat = np.arange(n, walk.n_frames - n) % n != 0
    assert body[is_repeat].mean() > 0.7
    assert not body[~is_repeat].any()


def test_frame_dropped_from_a_body_that_jitters_is_held(walk, add_jitter):
    """The jump is no larger than the jitter; that all parts repeat is what shows it."""
    frames = np.arange(walk.n_frames)
    frames[30] = 29
    held = find_held_samples(in_frames(add_jitter(walk, 3.0), frames))
    assert held[30, moving(walk)].all()
    assert not np.delete(held, 30, axis=0).any()


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
def test_nothing_is_held_in_a_movement(walk, degrees, add_jitter):
    assert not find_held_samples(add_jitter(walk, degrees)).any()


def test_pose_that_is_eased_out_of_is_not_held(walk):
    times = np.concatenate([np.arange(30.0), np.full(20, 29.0), 29 + np.arange(16) ** 2 / 6])
    assert not find_held_samples(at_times(walk, times)).any()


def test_anticipation_between_keys_is_not_held(arm, hold, add_jitter):
    """Keys of a wind-up, a pose and a strike that starts at full speed."""
    gait = walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))
    keys = np.array([0, 20, 36, 42, 60, 89])
    frames = np.arange(90)
    which = np.searchsorted(keys, frames, side="right").clip(1, 5) - 1
    time = (frames - keys[which]) / (keys[which + 1] - keys[which])
    eased = np.where(which == 2, 1 - (1 - time) ** 3, time**2 * (3 - 2 * time))
    poses = gait.rotations[[0, 12, 12, 40, 50, 70]]
    keyed = replace(
        gait,
        rotations=slerp(poses[which], poses[which + 1], eased[:, None]),
        root_positions=np.zeros((90, 3)),
    )
    assert not find_held_samples(keyed).any()
    assert find_held_samples(add_jitter(hold(keyed, slice(22, 36), arm), 0.0)).sum() == 0


@pytest.mark.parametrize("n", [4, 8])
def test_poses_on_steps_are_not_held(walk, n):
    assert not find_held_samples(repeat(walk, n)).any()


def test_joint_that_stops_and_goes_on_is_not_held(walk):
    speeds = np.concatenate([np.linspace(0.2, 3, 30), np.zeros(30), np.full(30, 3.0)])
    motion, _ = with_elbow(walk, np.cumsum(speeds))
    assert not find_held_samples(motion).any()


def test_fingers_of_a_glove_in_coarse_steps_are_not_held(walk):
    motion, _ = with_elbow(walk, 2.0 * np.round(8 * np.sin(np.arange(walk.n_frames) / 15.0)))
    assert not find_held_samples(motion).any()


@pytest.mark.parametrize("drift", [0.0, 0.5])
def test_limit_at_which_a_joint_stops_again_and_again_is_not_held(walk, drift):
    """A knee that sticks when it is straight, and then jumps; with drift no value recurs."""
    cycle = [40, 34, 28, 22, 16, 10, 5, 0, 0, 0, 0, 0, 0, 15, 22, 29, 36, 42, 46, 48, 47, 44]
    angles = np.resize(cycle, walk.n_frames).astype(float)
    angles += drift * (np.arange(walk.n_frames) // len(cycle))
    motion, elbow = with_elbow(walk, angles)
    assert find_held_samples(motion)[:, elbow].any() == (drift > 0.0)


def test_repeats_of_a_body_that_hardly_moves_do_not_matter(walk, add_jitter):
    slow = slerp(walk.rotations[:1], walk.rotations, np.full((1, 1), 0.005))
    slow = add_jitter(walk.with_poses(slow, walk.root_positions * 0.001), 0.02)
    assert not find_held_samples(repeat(slow, 2)).any()


def test_still_pose_at_the_start_is_not_held(walk):
    still = np.concatenate([np.full(15, 10), np.arange(30, 60)])
    assert not find_held_samples(in_frames(walk, still)).any()


@pytest.mark.parametrize(
    ("first", "start", "then", "begin", "n_repeats"),
    [
        ("run_angry", 5, "walk_tired", 20, 20),  # it jumps in another direction
        ("walk_normal", 10, "bow_active", 40, 2),  # it jumps too far
    ],
)
def test_pose_that_fills_up_a_joined_take_is_not_held(
    recordings, first, start, then, begin, n_repeats
):
    """An editor repeats the last pose up to the next clip: that jump is a cut."""
    folder = recordings / "corpus" / "bvh" / "bandai_namco"
    one = read_recording(folder / f"dataset-1_{first}_001.bvh").slice(start, start + 60)
    other = read_recording(folder / f"dataset-1_{then}_001.bvh").slice(begin, begin + 60)
    joined = replace(
        one,
        rotations=np.concatenate([one.rotations, other.rotations]),
        root_positions=np.concatenate([one.root_positions, other.root_positions]),
    )
    frames = np.concatenate([np.arange(60), np.full(n_repeats, 59), np.arange(60, 120)])
    filled_up = in_frames(joined, frames)
    assert not find_held_samples(filled_up)[60 : 60 + n_repeats].any()
    assert 60 + n_repeats in denoise(filled_up).cuts


def test_body_that_jumps_into_its_rest_pose_and_back_is_held(walk):
    """Both jumps look like cuts; between them the movement goes on."""
    rotations, frames = walk.rotations.copy(), slice(40, 49)
    rotations[frames] = [1.0, 0.0, 0.0, 0.0]
    lost = walk.with_poses(rotations)
    assert find_held_samples(lost)[frames, moving(walk)].all()
    assert denoise(lost).cuts == ()


def test_dropped_frames_are_no_cut(walk):
    """The body jumps after four repeats, as it does between two joined takes."""
    result = denoise(without_four_frames(walk))
    assert result.cuts == ()
    assert result.held[30:34].any(axis=1).all()


def test_repeats_in_a_separate_pose_at_the_start_are_kept(walk, add_jitter):
    """A T-pose of six frames, which is no movement to be filled."""
    t_pose = add_jitter(walk.slice(0, 6), 0.5)
    rotations = np.concatenate([t_pose.rotations, walk.rotations])
    rotations[:6] = multiply(
        rotations[:6], quaternion_from_rotation_vector(np.array([0.0, 0.0, 1.5]))
    )
    rotations[2:4] = rotations[1]
    roots = np.concatenate([t_pose.root_positions, walk.root_positions])
    result = denoise(replace(walk, rotations=rotations, root_positions=roots))
    assert result.cuts == (6,)
    assert not result.held[:6].any()
    assert angle_between(result.recording.rotations[:6], rotations[:6]).max() < 1e-6


def test_check_lists_the_arm_that_stands_still_and_the_body(walk, arm, hold):
    lost = hold(walk, LOST, arm)
    issues = find_worst_issues(lost, measure_quality(lost))
    sentences = {each.joint: each.sentence for each in issues if each.kind == "gap"}
    assert sentences["RightArm"] == "RightArm and 2 more stand still for 0.53 s and then jump."
    frames = np.arange(walk.n_frames)
    frames[30:34] = 29
    (gap,) = (each for each in find_worst_issues(in_frames(walk, frames)) if each.kind == "gap")
    assert (gap.start_frame, gap.stop_frame) == (30, 34)
    assert gap.sentence == "The entire body repeats a pose for 0.13 s before it moves on."


def test_check_distinguishes_missing_from_held(walk, arm):
    """A joint that is never observed stays so in a take with dropped frames."""
    dropped = without_four_frames(walk)
    rotations = dropped.rotations.copy()
    rotations[:, arm[0]] = np.nan
    issues = find_worst_issues(dropped.with_poses(rotations))
    (sentence,) = (each.sentence for each in issues if each.joint == "RightArm")
    assert sentence == "RightArm is never observed."
