"""Lost points are found again from those that move along with them."""

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
    """Four seconds of two rigid clusters of five markers, hinged to each other."""
    rng = np.random.default_rng(5)
    time = np.arange(240) / RATE
    swing = np.stack([np.sin(2 * time), 0.5 * np.sin(3 * time + 1), 0.7 * time], axis=1)
    trunk = matrices_from(swing)
    bend = matrices_from(np.stack([0.9 * np.sin(4 * time), 0 * time, 0 * time], axis=1))
    near, far = rng.uniform(-0.2, 0.2, (2, 5, 3))
    position = np.stack([time, np.cos(time), 1 + 0.1 * np.sin(5 * time)], axis=1)[:, None]
    first = np.einsum("fij,pj->fpi", trunk, near) + position
    hinge = np.einsum("fij,j->fi", trunk, [0.0, 0.0, 0.3])[:, None] + position
    second = np.einsum("fij,fjk,pk->fpi", trunk, bend, far + np.array([0, 0, 0.3])) + hinge
    return np.concatenate([first, second], axis=1)


def gapped(positions, points, frames=GAP):
    positions = positions.copy()
    positions[frames, points] = np.nan
    return positions


def test_a_marker_of_a_rigid_body_is_found_exactly(body):
    found = fill_markers(tracks_of(gapped(body[:, :5], 2)))
    assert np.abs(found.tracks.positions - body[:, :5]).max() < 1e-6
    assert found.filled.sum() == 60
    assert found.deviation.max() < 1e-5


def test_what_was_seen_is_returned_as_it_is(body):
    given = gapped(body, [1, 7])
    found = fill_markers(tracks_of(given)).tracks.positions
    observed = np.isfinite(given)
    assert (found[observed] == given[observed]).all()


def test_two_of_a_cluster_lost_at_once_are_told_by_the_other_three(body):
    found = fill_markers(tracks_of(gapped(body, [6, 8]))).tracks.positions
    assert np.linalg.norm(found - body, axis=2).max() < 5e-4


def test_turning_and_moving_the_take_turns_and_moves_what_is_filled(body):
    noisy = body + np.random.default_rng(1).normal(scale=0.002, size=body.shape)
    given = gapped(noisy, [1, 7])
    turn, shift = matrices_from(np.array([0.3, -1.2, 2.0])), np.array([3.0, -2.0, 0.5])
    expected = fill_markers(tracks_of(given)).tracks.positions @ turn.T + shift
    moved = fill_markers(tracks_of(given @ turn.T + shift)).tracks.positions
    assert np.allclose(moved, expected, atol=1e-7)


def test_the_order_of_markers_does_not_matter(body):
    noisy = body + np.random.default_rng(2).normal(scale=0.002, size=body.shape)
    order = np.random.default_rng(3).permutation(10)
    given = gapped(noisy, [1, 7])
    found = fill_markers(tracks_of(given)).tracks.positions
    mixed = fill_markers(tracks_of(given[:, order])).tracks.positions
    assert np.allclose(mixed, found[:, order], atol=1e-7)


def test_spikes_of_other_markers_do_no_harm(body):
    rng = np.random.default_rng(4)
    given = gapped(body, 7)
    hit = rng.random(given.shape[:2]) < 0.01
    given[hit] += rng.normal(scale=0.2, size=(hit.sum(), 3))
    found = fill_markers(tracks_of(given)).tracks.positions
    assert np.linalg.norm(found - body, axis=2)[GAP, 7].mean() < 2e-3


def test_the_fill_meets_what_is_seen_without_a_step(body):
    find_transient_outliers = (
        body + 0.03 * np.sin(np.arange(2400).reshape(240, 10) / 57.0)[..., None]
    )
    found = fill_markers(tracks_of(gapped(find_transient_outliers, 7))).tracks.positions[:, 7]
    steps = np.linalg.norm(np.diff(found, n=2, axis=0), axis=1)
    assert steps[GAP.start - 2 : GAP.start + 1].max() < 0.01
    assert steps[GAP.stop - 2 : GAP.stop + 1].max() < 0.01


def test_what_was_missed_at_a_border_is_made_up_for_and_fades_inside():
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


def test_the_expected_error_is_what_the_error_is(body):
    noisy = body + np.random.default_rng(6).normal(scale=0.003, size=body.shape)
    found = fill_markers(tracks_of(gapped(noisy, [1, 7])))
    error = (found.tracks.positions - noisy)[found.filled]
    expected = np.sqrt((found.deviation[found.filled] ** 2).mean())
    assert 0.5 < expected / np.sqrt((error**2).mean()) < 2.0


def test_copies_and_markers_that_rest_or_were_never_seen_are_no_obstacle(body):
    more = np.concatenate([body, body[:, :3], np.zeros((240, 2, 3)), body[:, :1]], axis=1)
    more[:, -1] = np.nan
    found = fill_markers(tracks_of(gapped(more, [1, 11, 13]))).tracks.positions
    assert np.linalg.norm(found - more, axis=2)[GAP, 1].max() < 1e-4
    assert np.isnan(found[:, -1]).all()


@pytest.mark.parametrize("n_points", [1, 2, 3])
def test_of_fewer_than_three_others_nothing_is_told(body, n_points):
    given = gapped(body[:, :n_points], 0)
    found = fill_markers(tracks_of(given))
    assert not found.filled.any()
    assert np.isfinite(denoise(tracks_of(given)).recording.positions).all()


def test_frames_in_which_all_are_lost_are_left_to_the_filter(body):
    given = gapped(body, slice(None))
    given[60:150, 2] = np.nan
    found = fill_markers(tracks_of(given))
    assert not found.filled[GAP].any()
    assert found.filled[60:70, 2].all()
    assert np.linalg.norm(found.tracks.positions - body, axis=2)[60:70, 2].max() < 1e-3


@pytest.mark.parametrize("n_frames", [1, 3, 9])
def test_short_takes_do_not_fail(body, n_frames):
    given = body[:n_frames].copy()
    given[: n_frames // 2 + 1, 4] = np.nan
    found = fill_markers(tracks_of(given)).tracks.positions
    assert np.isfinite(found[:, :4]).all()


def test_filling_can_be_cancelled(body):
    def cancel(fraction, _):
        raise SolveCancelled

    with pytest.raises(SolveCancelled):
        fill_markers(tracks_of(gapped(body, 2)), cancel)


def test_denoise_keeps_the_fill_and_says_how_sure_it_is(body):
    noisy = body + np.random.default_rng(8).normal(scale=0.001, size=body.shape)
    given = gapped(noisy, [1, 7])
    done = denoise(tracks_of(given))
    error = np.linalg.norm(done.recording.positions - body, axis=2)
    assert error[GAP][:, [1, 7]].mean() < 0.003
    assert not done.outliers[GAP][:, [1, 7]].any()
    assert (done.confidence[GAP][:, [1, 7]] > 0.9).all()
    untouched = denoise(tracks_of(given), settings=DenoiseSettings(strength=0.0)).recording
    observed = np.isfinite(given)
    assert (untouched.positions[observed] == given[observed]).all()


def test_a_marker_that_nothing_shows_stays_unknown(body):
    done = denoise(tracks_of(gapped(body, 4, slice(None))))

    missing_points = np.isnan(done.recording.positions).all(axis=(0, 2))
    assert missing_points.tolist() == [point == 4 for point in range(10)]
    assert np.isfinite(done.recording.positions[:, ~missing_points]).all()
    assert (done.confidence[:, 4] == 0.0).all()


def test_a_point_that_blinks_between_long_gaps_does_not_drift_away():
    rng = np.random.default_rng(1)
    time = np.arange(900) / 400.0
    path = np.stack([np.sin(3 * time), np.cos(2 * time), 1 + 0.3 * np.sin(5 * time)], axis=1)
    positions = np.full((900, 1, 3), np.nan)
    for start in rng.integers(0, 860, 12):
        blinks = start + np.arange(0, 30, 3)
        positions[blinks, 0] = path[blinks] + rng.normal(0.0, 0.001, (10, 3))

    found = denoise(Tracks(("slot",), positions, 400.0)).recording.positions

    error = np.linalg.norm(found[:, 0] - path, axis=1)
    assert np.median(error) < 0.15
    assert error.max() < 4.0


def test_a_marker_that_only_examples_show_is_known_from_them(recordings):
    take = read_c3d(recordings / "mocap" / "05_13.c3d")
    truth = take.positions[:1200:4, :41]
    complete = Tracks(take.names[:41], truth, take.frame_rate / 4)
    given = complete.with_positions(gapped(truth, 7, slice(None)))

    found = denoise(given, learn_filter_bases([complete])).recording.positions

    assert np.linalg.norm(found[:, 7] - truth[:, 7], axis=1).mean() < 0.01


def test_five_markers_of_a_dancer_are_found_to_a_centimetre(recordings):
    take = read_c3d(recordings / "mocap" / "05_13.c3d")
    truth = take.positions[:, :41]
    missing = slice(400, 520), [3, 15, 22, 30, 38]
    given = truth.copy()
    given[missing] = np.nan
    found = fill_markers(Tracks(take.names[:41], given, take.frame_rate)).tracks.positions
    assert np.linalg.norm((found - truth)[missing], axis=-1).mean() < 0.01


def test_only_what_jumps_away_and_back_is_stray(body):
    given = gapped(body, 7)
    given[40, 3] += [0.0, 0.2, 0.0]
    given[60:62, 4] += [0.2, 0.0, 0.0]
    found = find_transient_outliers(given)
    assert found[40, 3]
    assert found[60:62, 4].all()
    assert not found[:, [0, 1, 2, 5, 6, 7, 8, 9]].any()
    assert found[:, 3].sum() == 1
    assert found[:, 4].sum() <= 4
