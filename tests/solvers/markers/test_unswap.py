"""Swapped and mistaken labels: found, put right, and nothing else touched."""

import numpy as np
import pytest
from marked_bodies import markers_on

from solvers.markers import Swap, UnswapSettings, unswap_markers
from solvers.markers.pair_swaps import _viterbi
from solvers.motion import Tracks
from solvers.recordings import read_c3d
from solvers.recordings.joint_files.ui_prmd import read_ui_prmd_pair
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def take() -> Tracks:
    walk = walking_gait(GaitSettings(duration=4.0, frame_rate=60.0))
    return markers_on(walk, noise=0.0005, skin=0.003)


def swapped(take: Tracks, names: list[str], start: int, stop: int) -> Tracks:
    positions = take.positions.copy()
    places = [take.names.index(name) for name in names]
    positions[start:stop, places] = positions[start:stop, places[1:] + places[:1]]
    return take.with_positions(positions)


def same(one: Tracks, other: Tracks) -> bool:
    return np.array_equal(one.positions, other.positions, equal_nan=True)


@pytest.mark.parametrize(
    "names", [["LWRA", "LWRB"], ["LTOE", "RTOE"], ["LFHD", "RFHD"], ["LKNE", "RFIN"]]
)
@pytest.mark.parametrize(("start", "stop"), [(60, 61), (60, 110), (0, 50), (150, 240)])
def test_puts_a_swapped_pair_right_to_the_frame(take, names, start, stop):
    result = unswap_markers(swapped(take, names, start, stop))

    assert same(result.tracks, take)
    (swap,) = result.swaps
    assert set(swap.names) == set(names) and swap.frames == range(start, stop)


def test_leaves_a_clean_take_alone(take):
    result = unswap_markers(take)

    assert result.swaps == () and same(result.tracks, take)


def test_puts_several_swaps_and_a_round_of_three_right(take):
    wrong = swapped(take, ["LWRA", "LWRB"], 30, 80)
    wrong = swapped(wrong, ["LTOE", "RTOE"], 60, 100)
    wrong = swapped(wrong, ["LFHD", "RFHD", "LBHD"], 120, 170)
    wrong = swapped(wrong, ["LKNE", "LSHN"], 200, 240)

    assert same(unswap_markers(wrong).tracks, take)


def test_markers_that_pass_through_each_other_are_no_swap():
    """Two markers that meet, each in a cluster of its own that tells it apart."""
    time = np.arange(240) / 60.0
    shape = np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.12, 0], [0, 0, 0.15], [0.08, 0.1, 0.1]])
    path = np.stack([np.sin(time), 0 * time, 0 * time], axis=1)[:, None]
    left, right = shape + path, -shape - path + [0.0, 0.001, 0.0]
    places = np.concatenate([left, right], axis=1)
    take = Tracks(tuple("abcdefghij"), places, 60.0)
    nearest = np.linalg.norm(places[:, 0] - places[:, 5], axis=1).min()

    assert nearest < 0.01
    assert unswap_markers(take).swaps == ()


def test_finds_a_swap_that_begins_and_ends_in_gaps(take):
    names = ["LWRA", "LFRM"]
    places = [take.names.index(name) for name in names]
    truth = take.positions.copy()
    truth[60:75, places] = truth[130:145, places] = np.nan
    wrong = swapped(take.with_positions(truth), names, 75, 130)

    assert same(unswap_markers(wrong).tracks, take.with_positions(truth))


def test_a_marker_that_comes_back_under_the_name_of_a_lost_one_is_renamed(take):
    lost, found = take.names.index("LFHD"), take.names.index("LBHD")
    truth, wrong = take.positions.copy(), take.positions.copy()
    truth[80:140, lost] = np.nan
    wrong[80:140, lost] = wrong[80:140, found]
    wrong[80:140, found] = np.nan

    result = unswap_markers(take.with_positions(wrong))

    assert same(result.tracks, take.with_positions(truth))
    assert result.swaps == (Swap(("LFHD", "LBHD"), range(80, 140)),)


def test_confidence_goes_with_the_marker(take):
    confidence = np.linspace(0, 1, take.n_frames * take.n_points).reshape(take.n_frames, -1)
    sure = Tracks(take.names, take.positions, take.frame_rate, confidence)
    places = [take.names.index(name) for name in ("LWRA", "LWRB")]
    wrong, theirs = take.positions.copy(), confidence.copy()
    wrong[50:90, places] = wrong[50:90, places[::-1]]
    theirs[50:90, places] = theirs[50:90, places[::-1]]

    result = unswap_markers(Tracks(take.names, wrong, take.frame_rate, theirs))

    assert np.array_equal(result.tracks.confidence, sure.confidence)


def test_more_evidence_can_be_asked_for(take):
    wrong = swapped(take, ["LWRA", "LWRB"], 60, 61)

    assert unswap_markers(wrong, settings=UnswapSettings(evidence=100.0)).swaps == ()


@pytest.mark.parametrize("shape", [(1, 3), (2, 1), (50, 2)])
def test_little_or_nothing_seen_is_no_trouble(shape):
    names = tuple(f"m{n}" for n in range(shape[1]))

    for fill in (np.nan, 1.0):
        tracks = Tracks(names, np.full((*shape, 3), fill), 60.0)
        assert unswap_markers(tracks).swaps == ()


def test_the_course_of_labels_is_the_cheapest_of_all(rng):
    stay, change, swapped_cost = (
        rng.uniform(0, 3, 10),
        rng.uniform(0, 3, 10),
        rng.normal(size=10),
    )
    courses = (np.arange(2**10)[:, None] >> np.arange(10)) % 2
    turns = np.diff(courses, axis=1) != 0
    cost = np.where(turns, change[1:], stay[1:]).sum(axis=1) + courses @ swapped_cost

    assert np.array_equal(_viterbi(stay, change, swapped_cost), courses[cost.argmin()])


@pytest.mark.parametrize("file", ["85_02.c3d", "HDM_bd_05-01_01_120.c3d"])
def test_leaves_real_takes_alone_that_are_clean(recordings, file):
    take = read_c3d(recordings / "markers" / file)
    kept = [n for n, name in enumerate(take.names) if not name.startswith("*")]
    names = tuple(take.names[n] for n in kept)

    assert unswap_markers(Tracks(names, take.positions[:, kept], 120.0)).swaps == ()


def test_finds_the_swap_that_a_real_recording_has(recordings):
    """Two markers on a foot change places for one frame, as their paths show."""
    take = read_c3d(recordings / "formats" / "c3d" / "sample_OptiTrack_walking.c3d")

    result = unswap_markers(take)

    assert Swap(("Foot_Marker3", "Foot_Marker5"), range(1952, 1953)) in result.swaps
    place = take.names.index("Foot_Marker3")
    step = np.linalg.norm(np.diff(result.tracks.positions[1945:1960, place], axis=0), axis=1)
    assert step.max() < 0.01


def test_puts_feet_and_wrists_of_a_real_take_right(recordings):
    _, take = read_ui_prmd_pair(recordings / "kinect/ui_prmd/m04_s02_e03.npz")
    wrong = swapped(take, ["LWRA", "LWRB"], 10, 30)
    wrong = swapped(wrong, ["LANK", "RANK"], 20, 45)

    assert same(unswap_markers(wrong).tracks, take)
