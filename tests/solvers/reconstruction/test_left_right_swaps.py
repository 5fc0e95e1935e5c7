"""Left-right swaps are corrected, and similar movements stay unchanged."""

import kinect_walks
import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers import motion, samples
from solvers.motion import JointRecording, Tracks
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction import reconstruct
from solvers.reconstruction.reliability.left_right_swaps import fix_left_right_swaps
from solvers.recordings import read_recording

ARMS, LEGS = ("Elbow", "Wrist", "Hand"), ("Knee", "Ankle", "Foot")
ALL = ("Shoulder", "Hip", *ARMS, *LEGS)


@pytest.fixture(scope="module")
def walk():
    true = kinect_walks.true_positions(samples, posture_joints)
    tracked = kinect_walks.tracked_walk(motion, true)
    observed = true + np.random.default_rng(4).normal(scale=0.005, size=true.shape)
    return JointRecording(
        Tracks(
            tracked.names, observed, 30.0, np.random.default_rng(5).random(observed.shape[:2])
        ),
        tracked.tracking_state,
        tracked.sensor,
    )


def swapped(take, parts, frames):
    """Swap left and right joints of these parts, with their states."""
    names = take.names
    left = [index for index, name in enumerate(names) if name in {f"{p}Left" for p in parts}]
    right = [names.index(names[index].replace("Left", "Right")) for index in left]
    order = np.arange(len(names))
    order[left], order[right] = right, left

    def changed(values):
        if values is None:
            return None
        values = values.copy()
        values[frames] = values[frames][:, order]
        return values

    tracks = take.tracks
    return JointRecording(
        Tracks(names, changed(tracks.positions), take.frame_rate, changed(tracks.confidence)),
        changed(take.tracking_state),
        take.sensor,
    )


@pytest.mark.parametrize("n_frames", [1, 5, 10])
@pytest.mark.parametrize("parts", [ARMS, ("Shoulder", *ARMS), LEGS, ALL])
def test_swapped_joints_are_restored_bit_for_bit(walk, parts, n_frames):
    corrupted = swapped(walk, parts, slice(40, 40 + n_frames))
    assert np.abs(corrupted.tracks.positions - walk.tracks.positions).max() > 0.1

    found = fix_left_right_swaps(corrupted)

    assert_array_equal(found.tracks.positions, walk.tracks.positions)
    assert_array_equal(found.tracks.confidence, walk.tracks.confidence)
    assert_array_equal(found.tracking_state, walk.tracking_state)


@pytest.mark.parametrize("frames", [slice(0, 6), slice(80, 90)])
def test_swaps_in_the_first_and_last_frames_are_corrected(walk, frames):
    found = fix_left_right_swaps(swapped(walk, ALL, frames))

    assert_array_equal(found.tracks.positions, walk.tracks.positions)


def test_several_adjacent_swaps_are_corrected(walk):
    corrupted = swapped(walk, ARMS, [20, 21, 25, 40, 41, 42, 43])
    corrupted = swapped(corrupted, LEGS, [24, 25, 26])

    assert_array_equal(fix_left_right_swaps(corrupted).tracks.positions, walk.tracks.positions)


def test_joints_missing_at_the_swap_do_not_hide_it(walk):
    gone = walk.tracks.positions.copy()
    gone[38:42, walk.names.index("WristLeft")] = np.nan
    blank = JointRecording(walk.tracks.with_positions(gone), None, walk.sensor)
    corrupted = swapped(blank, ARMS, slice(40, 46))

    assert_array_equal(fix_left_right_swaps(corrupted).tracks.positions, gone)


def test_take_without_swaps_is_returned_unchanged(walk):
    assert fix_left_right_swaps(walk) is walk


def test_permanently_swapped_sides_stay_unchanged(walk):
    corrupted = swapped(walk, ALL, slice(45, None))

    assert fix_left_right_swaps(corrupted) is corrupted


def test_hands_crossing_in_one_frame_are_no_swap(walk):
    crossing = walk.tracks.positions.copy()
    hands = [[walk.names.index(f"{part}{side}") for part in ("Wrist", "Hand")]
             for side in ("Left", "Right")]  # fmt: skip
    crossing[40:45, hands[0]] = walk.tracks.positions[40:45, hands[1]]
    crossing[40:45, hands[1]] = walk.tracks.positions[40:45, hands[0]]
    take = JointRecording(walk.tracks.with_positions(crossing), None, walk.sensor)

    assert fix_left_right_swaps(take) is take


def test_fix_left_right_swaps_does_not_modify_its_input(walk):
    corrupted = swapped(walk, ALL, slice(40, 45))
    before = corrupted.tracks.positions.copy()

    fix_left_right_swaps(corrupted)

    assert_array_equal(corrupted.tracks.positions, before)


@pytest.mark.parametrize("folder", ["irds", "kimore", "laban"])
def test_intact_kinect_takes_have_no_swaps(recordings, folder):
    files = [path for path in (recordings / "kinect" / folder).iterdir() if path.is_file()]
    for path in sorted(files)[:12]:
        take = read_recording(path)
        assert fix_left_right_swaps(take) is take, path.name


@pytest.mark.parametrize("parts", [("Elbow", "Wrist", "Hand", "HandTip", "Thumb"), ALL])
@pytest.mark.parametrize("n_frames", [1, 5, 10])
def test_swapped_sides_of_a_real_take_are_corrected(recordings, parts, n_frames):
    take = read_recording(recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt")
    if parts is ALL:
        parts = (*ALL, "HandTip", "Thumb")
    start = take.n_frames // 2 - n_frames // 2
    corrupted = swapped(take, parts, slice(start, start + n_frames))

    found = reconstruct(corrupted).tracks.positions

    assert_allclose(found, reconstruct(take).tracks.positions, atol=0.005)


def standing(walk):
    """The positions of an actor who stands for as long as the walk lasts."""
    return walk.tracks.positions[40] + np.random.default_rng(6).normal(
        scale=0.003, size=walk.tracks.positions.shape
    )


def test_turn_of_an_occluded_body_is_no_swap(walk):
    """He faces away when the tracker finds him again, and turns back the same way."""
    positions = standing(walk)
    center = positions[:, [walk.names.index("HipCenter")], :2]
    positions[40:56, :, :2] = (2.0 * center - positions[:, :, :2])[40:56]
    positions[28:40] = positions[56:68] = np.nan
    take = JointRecording(walk.tracks.with_positions(positions), None, walk.sensor)

    assert fix_left_right_swaps(take) is take


def test_legs_side_by_side_are_not_swapped(walk):
    """Noise moves each of them to where the other one was, 5 cm away."""
    positions = standing(walk)
    for part in LEGS:
        left, right = (walk.names.index(f"{part}{side}") for side in ("Left", "Right"))
        positions[:, right] = positions[:, left] + (0.05, 0.0, 0.0)
    take = JointRecording(walk.tracks.with_positions(positions), None, walk.sensor)
    crossing = swapped(take, LEGS, slice(40, 45))

    assert fix_left_right_swaps(crossing) is crossing


@pytest.mark.parametrize(("duration", "corrected"), [(0.8, True), (1.4, False)])
def test_sides_that_stay_swapped_for_longer_than_a_second_are_left_alone(
    walk, duration, corrected
):
    """A body that turned around while it was lost looks the same."""
    positions = np.concatenate([standing(walk)] * 3)
    n_frames = round(duration * walk.frame_rate)
    take = JointRecording(Tracks(walk.names, positions, walk.frame_rate), None, walk.sensor)

    found = fix_left_right_swaps(swapped(take, ALL, slice(120, 120 + n_frames)))

    assert np.array_equal(found.tracks.positions, positions) == corrected
