"""Transient jumps are detected in their frames only, and fast movement is not."""

import kinect_walks
import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers import motion, samples
from solvers.motion import JointRecording
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction import ReliabilitySettings, measure_reliability, reconstruct
from solvers.reconstruction.reliability.transient_jumps import find_transient_jumps
from solvers.recordings import read_recording

CAUSAL = ReliabilitySettings(causal=True)


def path_along(*positions):
    """One joint along a line, shape (n_frames, 1, 3)."""
    path = np.zeros((len(positions), 1, 3))
    path[:, 0, 0] = positions
    return path


@pytest.mark.parametrize("n_displaced", [1, 2, 6])
def test_transient_jump_is_detected_in_its_frames_only(n_displaced):
    path = path_along(*np.linspace(0.0, 0.3, 40))
    path[20 : 20 + n_displaced, 0, 2] += 0.2

    found = find_transient_jumps(path, 30.0)

    assert np.flatnonzero(found[:, 0]).tolist() == list(range(20, 20 + n_displaced))


@pytest.mark.parametrize(
    "positions",
    [
        [0.0] * 10 + [0.3] * 7 + [0.0] * 10,  # seven frames are longer than a fifth of a second
        [0.0] * 10 + [0.3] * 15,  # it does not return
        [0.0] * 10 + [0.3] * 2 + [0.6] * 10,  # it does not return either
        [0.0] * 10 + [0.3, 0.0] * 6 + [0.0] * 10,  # shakes
        [0, 0, 0.05, 0.2, 0.4, 0.45, 0.3, 0.12, 0.02, 0, 0],  # a punch
        [0.0] * 10 + [0.1] * 2 + [0.0] * 10,  # 0.1 m in 1/30 s: 90 m/s^2
    ],
)
def test_short_jumps_exclude_other_movements(positions):
    assert not find_transient_jumps(path_along(*positions), 30.0).any()


def test_jumps_are_detected_equally_at_twice_the_frame_rate():
    slow = path_along(*[0.0] * 10, *[0.3] * 3, *[0.0] * 10)
    fast = np.repeat(slow, 2, axis=0)

    assert_array_equal(find_transient_jumps(fast, 60.0)[::2], find_transient_jumps(slow, 30.0))


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_the_shortest_takes_have_no_jumps(n_frames):
    assert not find_transient_jumps(path_along(*np.zeros(n_frames)), 30.0).any()


def test_missing_frames_are_not_jumps():
    path = path_along(*np.zeros(20))
    path[8:10] = np.nan

    assert not find_transient_jumps(path, 30.0).any()


@pytest.fixture(scope="module")
def walk():
    true = kinect_walks.true_positions(samples, posture_joints)
    tracked = kinect_walks.tracked_walk(motion, true)
    observed = true + np.random.default_rng(4).normal(scale=0.005, size=true.shape)
    return JointRecording(tracked.tracks.with_positions(observed), None, tracked.sensor)


def with_jump(take, name, frames, by=(0.4, 0.0, 0.0)):
    positions = take.tracks.positions.copy()
    positions[frames, take.names.index(name)] += by
    return take.with_tracks(take.tracks.with_positions(positions))


def test_wrong_frame_hardly_lowers_reliability_of_others(walk):
    before = measure_reliability(walk).combined
    after = measure_reliability(with_jump(walk, "WristLeft", 45)).combined

    wrist = walk.names.index("WristLeft")
    others = np.delete(np.arange(walk.n_frames), 45)
    assert after[45, wrist] == 0.0
    assert before[:, wrist].min() > 0.8
    assert after[others, wrist].min() > 0.6  # 0.05 to 0.1 within 0.8 s, if it counted in full
    assert np.abs(after - before)[:, np.arange(walk.n_joints) != wrist].max() < 0.1


def test_causal_reliability_is_low_even_if_the_joint_returns(walk):
    wrist = walk.names.index("WristLeft")
    for frames in (slice(45, 46), slice(45, 55)):
        found = measure_reliability(with_jump(walk, "WristLeft", frames), settings=CAUSAL)
        assert 0.0 < found.combined[45, wrist] < 0.5


def test_frames_next_to_a_wrong_one_stay_unchanged(walk):
    wrist = walk.names.index("WristLeft")
    before = reconstruct(walk).tracks.positions[:, wrist]
    after = reconstruct(with_jump(walk, "WristLeft", 45)).tracks.positions[:, wrist]

    errors = np.linalg.norm(after - before, axis=-1)
    assert errors[45] < 0.02
    assert np.delete(errors, 45).max() < 0.01


@pytest.mark.parametrize("frame_rate", [30.0, 20.0, 15.0, 12.0, 10.0])
def test_transient_wrist_jump_is_unreliable_at_any_rate(recordings, frame_rate):
    take = read_recording(recordings / "kinect" / "kimore" / "JointPositionExercise1.csv")
    frames = np.round(np.arange(0.0, 199.0, 30.0 / frame_rate)).astype(int)
    tracks = motion.Tracks(take.names, take.tracks.positions[frames], frame_rate)
    slow = JointRecording(tracks, None, take.sensor)
    middle, wrist = len(frames) // 2, take.names.index("WristLeft")

    sound = measure_reliability(slow).combined
    corrupted = measure_reliability(
        with_jump(slow, "WristLeft", middle, (0.5, 0.0, 0.3))
    ).combined

    assert corrupted[middle, wrist] < 0.1
    assert sound[:, wrist].mean() > 0.7
    assert (sound < 0.5).mean() < 0.03


@pytest.mark.parametrize("frame_rate", [120.0, 240.0])
def test_wobbles_of_two_centimeters_are_no_jumps_at_high_rates(frame_rate):
    path = path_along(*[0.0] * 20, *[0.02] * 2, *[0.0] * 20)

    assert not find_transient_jumps(path, frame_rate).any()
