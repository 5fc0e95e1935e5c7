"""Correct swapped and mistaken labels, and change nothing else."""

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
    indices = [take.names.index(name) for name in names]
    positions[start:stop, indices] = positions[start:stop, indices[1:] + indices[:1]]
    return take.with_positions(positions)


def same(one: Tracks, other: Tracks) -> bool:
    return np.array_equal(one.positions, other.positions, equal_nan=True)


@pytest.mark.parametrize(
    "names", [["LWRA", "LWRB"], ["LTOE", "RTOE"], ["LFHD", "RFHD"], ["LKNE", "RFIN"]]
)
@pytest.mark.parametrize(("start", "stop"), [(60, 61), (60, 110), (0, 50), (150, 240)])
def test_swapped_pair_is_corrected_in_exactly_its_frames(take, names, start, stop):
    result = unswap_markers(swapped(take, names, start, stop))

    assert same(result.tracks, take)
    (swap,) = result.swaps
    assert set(swap.names) == set(names) and swap.frames == range(start, stop)


def test_clean_take_stays_unchanged(take):
    result = unswap_markers(take)

    assert result.swaps == () and same(result.tracks, take)


def test_several_swaps_and_a_cycle_of_three_are_corrected(take):
    wrong = swapped(take, ["LWRA", "LWRB"], 30, 80)
    wrong = swapped(wrong, ["LTOE", "RTOE"], 60, 100)
    wrong = swapped(wrong, ["LFHD", "RFHD", "LBHD"], 120, 170)
    wrong = swapped(wrong, ["LKNE", "LSHN"], 200, 240)

    assert same(unswap_markers(wrong).tracks, take)


def test_markers_that_pass_each_other_are_not_swapped():
    """Two markers at the same position, each identified by its own cluster."""
    time = np.arange(240) / 60.0
    shape = np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.12, 0], [0, 0, 0.15], [0.08, 0.1, 0.1]])
    path = np.stack([np.sin(time), 0 * time, 0 * time], axis=1)[:, None]
    left, right = shape + path, -shape - path + [0.0, 0.001, 0.0]
    positions = np.concatenate([left, right], axis=1)
    take = Tracks(tuple("abcdefghij"), positions, 60.0)
    nearest = np.linalg.norm(positions[:, 0] - positions[:, 5], axis=1).min()

    assert nearest < 0.01
    assert unswap_markers(take).swaps == ()


def test_swap_between_gaps_is_corrected(take):
    names = ["LWRA", "LFRM"]
    indices = [take.names.index(name) for name in names]
    truth = take.positions.copy()
    truth[60:75, indices] = truth[130:145, indices] = np.nan
    wrong = swapped(take.with_positions(truth), names, 75, 130)

    assert same(unswap_markers(wrong).tracks, take.with_positions(truth))


@pytest.mark.parametrize("names", [("LFHD", "LBHD"), ("C7", "CLAV")])
def test_marker_with_the_label_of_a_missing_one_is_renamed(take, names):
    """The distances of C7 vary: its jump to the other label and back shows the mistake."""
    missing, found = (take.names.index(name) for name in names)
    truth, wrong = take.positions.copy(), take.positions.copy()
    truth[80:140, missing] = np.nan
    wrong[80:140, missing] = wrong[80:140, found]
    wrong[80:140, found] = np.nan

    result = unswap_markers(take.with_positions(wrong))

    assert same(result.tracks, take.with_positions(truth))
    assert result.swaps == (Swap(names, range(80, 140)),)


def test_marker_that_comes_back_after_a_gap_with_the_label_of_a_missing_one_is_renamed(take):
    """Nothing but its distances shows which marker it is: no label is handed over."""
    missing, found = take.names.index("LFHD"), take.names.index("LBHD")
    truth = take.positions.copy()
    truth[60:160, missing] = np.nan
    truth[60:80, found] = truth[140:160, found] = np.nan
    wrong = truth.copy()
    wrong[80:140, missing], wrong[80:140, found] = truth[80:140, found], np.nan

    result = unswap_markers(take.with_positions(wrong))

    assert same(result.tracks, take.with_positions(truth))


def test_confidence_follows_the_marker(take):
    confidence = np.linspace(0, 1, take.n_frames * take.n_points).reshape(take.n_frames, -1)
    certain = Tracks(take.names, take.positions, take.frame_rate, confidence)
    indices = [take.names.index(name) for name in ("LWRA", "LWRB")]
    wrong, swapped_confidence = take.positions.copy(), confidence.copy()
    wrong[50:90, indices] = wrong[50:90, indices[::-1]]
    swapped_confidence[50:90, indices] = swapped_confidence[50:90, indices[::-1]]

    result = unswap_markers(Tracks(take.names, wrong, take.frame_rate, swapped_confidence))

    assert np.array_equal(result.tracks.confidence, certain.confidence)


def test_required_evidence_is_a_setting(take):
    wrong = swapped(take, ["LWRA", "LWRB"], 60, 61)

    assert unswap_markers(wrong, settings=UnswapSettings(evidence=100.0)).swaps == ()


@pytest.mark.parametrize("shape", [(1, 3), (2, 1), (50, 2)])
def test_takes_with_few_observations_are_accepted(shape):
    names = tuple(f"m{n}" for n in range(shape[1]))

    for fill in (np.nan, 1.0):
        tracks = Tracks(names, np.full((*shape, 3), fill), 60.0)
        assert unswap_markers(tracks).swaps == ()


def test_viterbi_finds_the_cheapest_sequence_of_labels(rng):
    stay, change, swapped_cost = (
        rng.uniform(0, 3, 10),
        rng.uniform(0, 3, 10),
        rng.normal(size=10),
    )
    sequences = (np.arange(2**10)[:, None] >> np.arange(10)) % 2
    changes = np.diff(sequences, axis=1) != 0
    cost = np.where(changes, change[1:], stay[1:]).sum(axis=1) + sequences @ swapped_cost

    assert np.array_equal(_viterbi(stay, change, swapped_cost), sequences[cost.argmin()])


@pytest.mark.parametrize("file", ["85_02.c3d", "HDM_bd_05-01_01_120.c3d"])
def test_clean_real_takes_stay_unchanged(recordings, file):
    take = read_c3d(recordings / "markers" / file)
    named = [n for n, name in enumerate(take.names) if not name.startswith("*")]
    names = tuple(take.names[n] for n in named)

    assert unswap_markers(Tracks(names, take.positions[:, named], 120.0)).swaps == ()


def test_swap_in_a_real_recording_is_found(recordings):
    """Two markers on a foot are swapped for one frame, as their paths show."""
    take = read_c3d(recordings / "formats" / "c3d" / "sample_OptiTrack_walking.c3d")

    result = unswap_markers(take)

    assert Swap(("Foot_Marker3", "Foot_Marker5"), range(1952, 1953)) in result.swaps
    index = take.names.index("Foot_Marker3")
    step = np.linalg.norm(np.diff(result.tracks.positions[1945:1960, index], axis=0), axis=1)
    assert step.max() < 0.01


def test_swapped_feet_and_wrists_of_a_real_take_are_corrected(recordings):
    _, take = read_ui_prmd_pair(recordings / "kinect/ui_prmd/m04_s02_e03.npz")
    wrong = swapped(take, ["LWRA", "LWRB"], 10, 30)
    wrong = swapped(wrong, ["LANK", "RANK"], 20, 45)

    assert same(unswap_markers(wrong).tracks, take)
