"""Reliability of optical markers: neighbours that keep their distances, cameras, vibration."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Tracks
from solvers.motion.humanoid.posture_heading import turned
from solvers.reconstruction import measure_marker_reliability
from solvers.recordings import read_c3d

N_FRAMES = 300


@pytest.fixture
def markers(rng) -> Tracks:
    """Two stiff things of six markers each that go their own ways, 120 Hz."""
    time = np.arange(N_FRAMES) / 120.0
    parts = []
    for number, turn in enumerate((0.8, -1.3)):
        shape = rng.uniform(-0.15, 0.15, size=(1, 6, 3)).repeat(N_FRAMES, axis=0)
        way = np.stack([number + 0.0 * time, time, 1.0 + 0.2 * np.sin(3.0 * time)], axis=-1)
        parts.append(turned(shape, turn * time) + way[:, None])
    positions = np.concatenate(parts, axis=1) + rng.normal(scale=0.0005, size=(1, 12, 3))
    return Tracks(tuple("abcdefghijkl"), positions, 120.0)


def test_markers_that_keep_together_are_believed(markers):
    assert measure_marker_reliability(markers).combined.min() > 0.999


def test_a_marker_that_strays_is_doubted_alone(markers):
    positions = markers.positions.copy()
    positions[100:150, 2] += (0.0, 0.0, 0.06)

    found = measure_marker_reliability(markers.with_positions(positions))

    assert found.kinematics[100:150, 2].max() < 0.2
    assert found.combined[110:140, 2].max() < 0.2
    assert np.delete(found.combined, 2, axis=1).min() > 0.999
    assert np.delete(found.kinematics[:, 2], range(100, 150)).min() > 0.999


def test_swapped_markers_are_both_doubted(markers):
    positions = markers.positions.copy()
    positions[60:90, [1, 8]] = positions[60:90, [8, 1]]

    found = measure_marker_reliability(markers.with_positions(positions)).combined

    assert found[70:80, [1, 8]].max() < 0.05
    assert np.delete(found, [1, 8], axis=1).min() > 0.999


@pytest.mark.parametrize(
    ("n_cameras", "term"), [(0, 0.0), (1, 0.0), (2, 1 / 3), (4, 1.0), (9, 1.0)]
)
def test_cameras_count(markers, n_cameras, term):
    counts = np.full((N_FRAMES, 12), 6)
    counts[:, 3] = n_cameras

    found = measure_marker_reliability(markers, counts)

    assert_allclose(found.tracking[:, 3], term)
    assert_allclose(found.combined[:, 3], min(term, 1.0), atol=1e-3)
    assert_allclose(np.delete(found.tracking, 3, axis=1), 1.0)


def test_counts_of_another_shape_are_refused(markers):
    with pytest.raises(InvalidMotionError, match=r"Counts of cameras need shape \(300, 12\)"):
        measure_marker_reliability(markers, np.zeros((300, 11), int))


def test_lost_markers_have_none_and_do_not_harm_others(markers):
    positions = markers.positions.copy()
    positions[:, 4] = np.nan
    positions[50:80, 0] = np.nan

    found = measure_marker_reliability(markers.with_positions(positions)).combined

    assert (found[:, 4] == 0.0).all()
    assert (found[50:80, 0] == 0.0).all()
    assert found[:, [1, 2, 3, *range(5, 12)]].min() > 0.999


def test_neither_place_nor_heading_counts(markers):
    positions = markers.positions.copy()
    positions[100:120, 5] += 0.03
    moved = turned(positions, np.full(N_FRAMES, 1.0)) + np.array([5.0, 1.0, 0.0])

    one = measure_marker_reliability(markers.with_positions(positions))
    other = measure_marker_reliability(markers.with_positions(moved))

    assert_allclose(one.combined, other.combined, atol=1e-9)


def test_a_single_marker_has_no_neighbours_to_ask():
    alone = Tracks(("m",), np.zeros((3, 1, 3)), 120.0)

    assert_allclose(measure_marker_reliability(alone).combined, 1.0)


def test_of_two_markers_both_are_doubted():
    pair = np.tile([[[0.0, 0.0, 1.0], [0.1, 0.0, 1.0]]], (100, 1, 1))
    pair[40:60, 0, 0] -= 0.05

    found = measure_marker_reliability(Tracks(("a", "b"), pair, 120.0)).kinematics

    assert_allclose(found[40:60], 0.0)
    assert_allclose(found[:40], 1.0)


def test_a_real_take_is_believed_but_where_it_is_spoilt(recordings):
    take = read_c3d(recordings / "markers" / "85_02.c3d")
    spoilt = take.positions.copy()
    spoilt[300:360, [5, 20]] = spoilt[300:360, [20, 5]]

    clean = measure_marker_reliability(take)
    found = measure_marker_reliability(take.with_positions(spoilt))

    assert clean.combined.mean() > 0.98
    assert found.combined[310:350, [5, 20]].max() < 0.2
    assert np.abs(np.delete(found.combined - clean.combined, [5, 20], axis=1)).max() < 0.2
