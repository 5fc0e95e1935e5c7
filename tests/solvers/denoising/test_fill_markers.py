"""Missing markers are predicted from those that move with them."""

import numpy as np
import pytest

from solvers.denoising import DenoiseSettings, denoise, learn_filter_bases
from solvers.denoising.marker_gaps.fill_markers import fill_markers
from solvers.denoising.marker_gaps.gap_boundaries import extrapolate_boundary_errors
from solvers.denoising.marker_gaps.transient_outliers import find_transient_outliers
from solvers.errors import SolveCancelled
from solvers.motion import Tracks
from solvers.recordings import read_c3d
from solvers.rotations.representations import (
    matrix_from_quaternion,
    quaternion_from_rotation_vector,
)

RATE = 60.0
GAP = slice(70, 130)


def matrices_from(vectors):
    return matrix_from_quaternion(quaternion_from_rotation_vector(vectors))


def tracks_of(positions):
    names = tuple(f"m{point}" for point in range(positions.shape[1]))
    return Tracks(names, positions, RATE)


@pytest.fixture
def body():
    """Four seconds of two rigid clusters of five markers, joined by a hinge."""
    rng = np.random.default_rng(5)
    time = np.arange(240) / RATE
    swing = np.stack([np.sin(2 * time), 0.5 * np.sin(3 * time + 1), 0.7 * time], axis=1)
    trunk = matrices_from(swing)
    flexion = matrices_from(np.stack([0.9 * np.sin(4 * time), 0 * time, 0 * time], axis=1))
    near_cluster, far_cluster = rng.uniform(-0.2, 0.2, (2, 5, 3))
    position = np.stack([time, np.cos(time), 1 + 0.1 * np.sin(5 * time)], axis=1)[:, None]
    first = np.einsum("fij,pj->fpi", trunk, near_cluster) + position
    hinge = np.einsum("fij,j->fi", trunk, [0.0, 0.0, 0.3])[:, None] + position
    second = (
        np.einsum("fij,fjk,pk->fpi", trunk, flexion, far_cluster + np.array([0, 0, 0.3]))
        + hinge
    )
    return np.concatenate([first, second], axis=1)


def gapped(positions, points, frames=GAP):
    positions = positions.copy()
    positions[frames, points] = np.nan
    return positions


def test_marker_of_a_rigid_body_is_predicted_exactly(body):
    filled = fill_markers(tracks_of(gapped(body[:, :5], 2)))
    assert np.abs(filled.tracks.positions - body[:, :5]).max() < 1e-6
    assert filled.filled.sum() == 60
    assert filled.deviation.max() < 1e-5


def test_observed_positions_are_returned_unchanged(body):
    gapped_take = gapped(body, [1, 7])
    filled = fill_markers(tracks_of(gapped_take)).tracks.positions
    observed = np.isfinite(gapped_take)
    assert (filled[observed] == gapped_take[observed]).all()


def test_two_markers_are_predicted_from_three_of_their_cluster(body):
    filled = fill_markers(tracks_of(gapped(body, [6, 8]))).tracks.positions
    assert np.linalg.norm(filled - body, axis=2).max() < 5e-4


def test_fill_rotates_and_moves_with_the_take(body):
    noisy = body + np.random.default_rng(1).normal(scale=0.002, size=body.shape)
    gapped_take = gapped(noisy, [1, 7])
    rotation, shift = matrices_from(np.array([0.3, -1.2, 2.0])), np.array([3.0, -2.0, 0.5])
    expected = fill_markers(tracks_of(gapped_take)).tracks.positions @ rotation.T + shift
    moved = fill_markers(tracks_of(gapped_take @ rotation.T + shift)).tracks.positions
    assert np.allclose(moved, expected, atol=1e-7)


def test_fill_is_independent_of_the_order_of_markers(body):
    noisy = body + np.random.default_rng(2).normal(scale=0.002, size=body.shape)
    order = np.random.default_rng(3).permutation(10)
    gapped_take = gapped(noisy, [1, 7])
    filled = fill_markers(tracks_of(gapped_take)).tracks.positions
    mixed = fill_markers(tracks_of(gapped_take[:, order])).tracks.positions
    assert np.allclose(mixed, filled[:, order], atol=1e-7)


def test_fill_is_robust_to_spikes_of_other_markers(body):
    rng = np.random.default_rng(4)
    gapped_take = gapped(body, 7)
    has_spike = rng.random(gapped_take.shape[:2]) < 0.01
    gapped_take[has_spike] += rng.normal(scale=0.2, size=(has_spike.sum(), 3))
    filled = fill_markers(tracks_of(gapped_take)).tracks.positions
    assert np.linalg.norm(filled - body, axis=2)[GAP, 7].mean() < 2e-3


def test_fill_has_no_step_at_its_boundaries(body):
    drifting = body + 0.03 * np.sin(np.arange(2400).reshape(240, 10) / 57.0)[..., None]
    filled = fill_markers(tracks_of(gapped(drifting, 7))).tracks.positions[:, 7]
    steps = np.linalg.norm(np.diff(filled, n=2, axis=0), axis=1)
    assert steps[GAP.start - 2 : GAP.start + 1].max() < 0.01
    assert steps[GAP.stop - 2 : GAP.stop + 1].max() < 0.01


def test_boundary_errors_are_corrected_and_fade_into_the_gap():
    training_frames, gap_frames = np.r_[0:50, 250:300], np.arange(50, 250)
    boundary_errors = np.where(
        training_frames[:, None] < 50, [0.01, 0.0, 0.0], [0.0, 0.02, 0.0]
    )
    correction = extrapolate_boundary_errors(
        boundary_errors, training_frames, gap_frames, 0.0, RATE
    )
    frames = np.arange(1, 201)
    fading = np.exp(-frames / (0.2 * RATE))
    assert np.allclose(correction[:, 0], 0.01 * fading, atol=1e-6)
    assert np.allclose(correction[:, 1], 0.02 * fading[::-1], atol=1e-6)


def test_expected_error_equals_the_actual_error(body):
    noisy = body + np.random.default_rng(6).normal(scale=0.003, size=body.shape)
    filled = fill_markers(tracks_of(gapped(noisy, [1, 7])))
    error = (filled.tracks.positions - noisy)[filled.filled]
    expected = np.sqrt((filled.deviation[filled.filled] ** 2).mean())
    assert 0.5 < expected / np.sqrt((error**2).mean()) < 2.0


def test_fill_handles_copies_still_markers_and_missing_markers(body):
    more = np.concatenate([body, body[:, :3], np.zeros((240, 2, 3)), body[:, :1]], axis=1)
    more[:, -1] = np.nan
    filled = fill_markers(tracks_of(gapped(more, [1, 11, 13]))).tracks.positions
    assert np.linalg.norm(filled - more, axis=2)[GAP, 1].max() < 1e-4
    assert np.isnan(filled[:, -1]).all()


@pytest.mark.parametrize("n_points", [1, 2, 3])
def test_nothing_is_filled_from_fewer_than_three_others(body, n_points):
    gapped_take = gapped(body[:, :n_points], 0)
    filled = fill_markers(tracks_of(gapped_take))
    assert not filled.filled.any()
    assert np.isfinite(denoise(tracks_of(gapped_take)).recording.positions).all()


def test_frames_without_any_marker_are_not_filled(body):
    gapped_take = gapped(body, slice(None))
    gapped_take[60:150, 2] = np.nan
    filled = fill_markers(tracks_of(gapped_take))
    assert not filled.filled[GAP].any()
    assert filled.filled[60:70, 2].all()
    assert np.linalg.norm(filled.tracks.positions - body, axis=2)[60:70, 2].max() < 1e-3


@pytest.mark.parametrize("n_frames", [1, 3, 9])
def test_short_takes_do_not_fail(body, n_frames):
    gapped_take = body[:n_frames].copy()
    gapped_take[: n_frames // 2 + 1, 4] = np.nan
    filled = fill_markers(tracks_of(gapped_take)).tracks.positions
    assert np.isfinite(filled[:, :4]).all()


def test_filling_can_be_cancelled(body, cancel):
    with pytest.raises(SolveCancelled):
        fill_markers(tracks_of(gapped(body, 2)), cancel)


def test_denoise_keeps_the_fill_and_its_confidence(body):
    noisy = body + np.random.default_rng(8).normal(scale=0.001, size=body.shape)
    gapped_take = gapped(noisy, [1, 7])
    result = denoise(tracks_of(gapped_take))
    error = np.linalg.norm(result.recording.positions - body, axis=2)
    assert error[GAP][:, [1, 7]].mean() < 0.003
    assert not result.outliers[GAP][:, [1, 7]].any()
    assert (result.confidence[GAP][:, [1, 7]] > 0.9).all()
    untouched = denoise(
        tracks_of(gapped_take), settings=DenoiseSettings(strength=0.0)
    ).recording
    observed = np.isfinite(gapped_take)
    assert (untouched.positions[observed] == gapped_take[observed]).all()


def test_marker_never_observed_stays_missing(body):
    result = denoise(tracks_of(gapped(body, 4, slice(None))))

    missing_points = np.isnan(result.recording.positions).all(axis=(0, 2))
    assert missing_points.tolist() == [point == 4 for point in range(10)]
    assert np.isfinite(result.recording.positions[:, ~missing_points]).all()
    assert (result.confidence[:, 4] == 0.0).all()


def test_point_that_flickers_between_long_gaps_does_not_drift():
    rng = np.random.default_rng(1)
    time = np.arange(900) / 400.0
    path = np.stack([np.sin(3 * time), np.cos(2 * time), 1 + 0.3 * np.sin(5 * time)], axis=1)
    positions = np.full((900, 1, 3), np.nan)
    for start in rng.integers(0, 860, 12):
        blinks = start + np.arange(0, 30, 3)
        positions[blinks, 0] = path[blinks] + rng.normal(0.0, 0.001, (10, 3))

    filled = denoise(Tracks(("slot",), positions, 400.0)).recording.positions

    error = np.linalg.norm(filled[:, 0] - path, axis=1)
    assert np.median(error) < 0.15
    assert error.max() < 4.0


def test_marker_in_the_examples_only_is_predicted_from_them(recordings):
    take = read_c3d(recordings / "mocap" / "05_13.c3d")
    truth = take.positions[:1200:4, :41]
    complete = Tracks(take.names[:41], truth, take.frame_rate / 4)
    gapped_take = complete.with_positions(gapped(truth, 7, slice(None)))

    filled = denoise(gapped_take, learn_filter_bases([complete])).recording.positions

    assert np.linalg.norm(filled[:, 7] - truth[:, 7], axis=1).mean() < 0.01


def test_five_markers_of_a_dancer_are_predicted_within_a_centimeter(recordings):
    take = read_c3d(recordings / "mocap" / "05_13.c3d")
    truth = take.positions[:, :41]
    missing = slice(400, 520), [3, 15, 22, 30, 38]
    gapped_take = truth.copy()
    gapped_take[missing] = np.nan
    filled = fill_markers(
        Tracks(take.names[:41], gapped_take, take.frame_rate)
    ).tracks.positions
    assert np.linalg.norm((filled - truth)[missing], axis=-1).mean() < 0.01


def test_only_short_jumps_are_transient_outliers(body):
    gapped_take = gapped(body, 7)
    gapped_take[40, 3] += [0.0, 0.2, 0.0]
    gapped_take[60:62, 4] += [0.2, 0.0, 0.0]
    filled = find_transient_outliers(gapped_take)
    assert filled[40, 3]
    assert filled[60:62, 4].all()
    assert not filled[:, [0, 1, 2, 5, 6, 7, 8, 9]].any()
    assert filled[:, 3].sum() == 1
    assert filled[:, 4].sum() <= 4


@pytest.mark.parametrize("n_observed", [1, 5])
def test_rarely_observed_marker_is_not_filled_with_high_confidence(body, n_observed):
    noisy = body + np.random.default_rng(9).normal(scale=0.003, size=body.shape)
    take = gapped(noisy, 7, np.r_[0:100, 100 + n_observed : 240])

    filled = fill_markers(tracks_of(take))

    assert not filled.filled[:, 7].any()
