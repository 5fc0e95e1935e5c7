"""Errors of some frames are found; kicks and clean takes are left alone."""

import numpy as np
import pytest

from solvers.denoising import denoise
from solvers.denoising.motion_model import load_motion_mixture
from solvers.denoising.outliers import PredictiveDensity, confirm_outliers, find_bursts
from solvers.denoising.outliers.likeliest_errors import _with_adjacent
from solvers.denoising.outliers.predictive_density import NEW_MOVEMENT_RATE
from solvers.denoising.window_priors import Windows
from solvers.motion import Motion
from solvers.samples import GaitSettings, walking_gait

MIXTURE = load_motion_mixture()


def walk_like(rate: float, rng: np.random.Generator) -> np.ndarray:
    """Two joints that swing as in a walk, with noise of .3 degrees, and a kick of the first."""
    time = np.arange(round(4.0 * rate)) / rate
    swing = 15.0 * np.sin(2.0 * np.pi * time[:, None] + np.arange(6.0))
    swing[:, 0] += 60.0 * np.exp(-0.5 * ((time - 2.0) / 0.08) ** 2)
    return np.asarray(swing + 0.3 * rng.normal(size=swing.shape))


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0])
def test_kick_is_no_error(rate, rng):
    assert not find_bursts(walk_like(rate, rng), rate, MIXTURE).any()


@pytest.mark.parametrize("rate", [60.0, 120.0])
def test_hips_that_are_put_elsewhere_for_a_moment_return(rate, rng):
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=rate))
    roots = walk.root_positions + rng.normal(scale=0.001, size=walk.root_positions.shape)
    roots[round(0.9 * rate) : round(1.1 * rate)] += [0.8, 0.5, 0.3]
    cleaned = denoise(walk.with_poses(root_positions=roots)).recording
    assert isinstance(cleaned, Motion)
    assert np.abs(cleaned.root_positions - walk.root_positions).max() < 0.03


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0])
@pytest.mark.parametrize("duration", [0.07, 0.2])
def test_burst_is_found_and_nothing_else(rate, duration, rng):
    samples = walk_like(rate, rng)
    start, stop = round(1.0 * rate), round((1.0 + duration) * rate)
    samples[start:stop, 3:] += [40.0, -30.0, 25.0]

    found = find_bursts(samples, rate, MIXTURE)

    expected = np.zeros(samples.shape, dtype=bool)
    expected[start:stop, 3:] = True
    assert (found == expected).all()


@pytest.mark.parametrize("n_frames", [5, 8])
def test_burst_in_a_still_joint_does_not_set_the_axes_of_its_own_test(n_frames, rng):
    samples = 0.3 * rng.normal(size=(150, 3))
    samples[60 : 60 + n_frames] += 15.0

    found = find_bursts(samples, 30.0, MIXTURE)

    expected = np.zeros(samples.shape, dtype=bool)
    expected[60 : 60 + n_frames] = True
    assert (found == expected).all()


def out_of_stillness(pulse: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """A joint that stands still for a second at 30 Hz, but for a movement by 90 degrees."""
    samples = 90.0 * pulse[:, None] * [1.0, -0.4, 0.3]
    return np.asarray(samples + 0.1 * rng.normal(size=samples.shape))


TIME = np.arange(36) / 30.0 - 0.6
KICK = np.exp(-0.5 * (TIME / 0.045) ** 2)


@pytest.mark.parametrize(("pulse", "is_error"), [(KICK, False), (abs(TIME) < 0.07, True)])
def test_kick_out_of_standing_still_is_cleared_and_a_burst_is_not(pulse, is_error, rng):
    samples = out_of_stillness(pulse, rng)
    suspected = np.tile(abs(TIME)[:, None] < 0.1, 3)
    complete = np.where(suspected, samples[:1], samples)

    assert confirm_outliers(samples, suspected, complete, 30.0, MIXTURE).any() == is_error


@pytest.mark.parametrize("offset", [0, 1])
def test_channels_that_are_suspected_together_are_one_event(offset, rng):
    samples = out_of_stillness(KICK, rng)[:24]
    suspected = np.zeros(samples.shape, dtype=bool)
    for channel in range(3):
        suspected[15 + offset * channel : 20, channel] = True
    complete = np.where(suspected, samples[:1], samples)

    assert not confirm_outliers(samples, suspected, complete, 30.0, MIXTURE).any()


def test_gap_is_no_error_and_hides_none(rng):
    samples = walk_like(30.0, rng)
    samples[20:30, 3:] = np.nan
    samples[40:44, 3:] += 45.0

    found = find_bursts(samples, 30.0, MIXTURE)

    assert not found[20:30].any()
    assert found[40:44, 3:].all()


def test_suspected_kick_is_cleared_and_a_spike_is_not(rng):
    samples = walk_like(30.0, rng)
    samples[30, 4] += 40.0
    suspected = np.zeros(samples.shape, dtype=bool)
    suspected[58:63, 0] = suspected[30, 4] = True
    complete = np.where(suspected, np.nan, samples)
    for column in complete.T:
        known = np.isfinite(column)
        column[~known] = np.interp(np.flatnonzero(~known), np.flatnonzero(known), column[known])

    confirmed = confirm_outliers(samples, suspected, complete, 30.0, MIXTURE)

    assert np.argwhere(confirmed).tolist() == [[30, 4]]


@pytest.mark.parametrize(("pulse", "is_error"), [(KICK, False), (abs(TIME) < 0.07, True)])
def test_take_shorter_than_a_window_is_tested_all_the_same(pulse, is_error, rng):
    samples = out_of_stillness(pulse, rng)[11:26]
    suspected = np.tile(abs(TIME[11:26, None]) < 0.1, 3)
    complete = np.where(suspected, samples[:1], samples)

    assert confirm_outliers(samples, suspected, complete, 30.0, MIXTURE).any() == is_error
    assert not find_bursts(samples[:5], 30.0, MIXTURE).any()


def test_kick_of_a_joint_that_is_often_wrong_is_cleared(rng):
    samples = walk_like(30.0, rng)
    complete, suspected = samples.copy(), np.zeros(samples.shape, dtype=bool)
    spikes = np.arange(3, 110, 4)
    samples[spikes, 1] += 40.0
    suspected[spikes, 1] = True
    expected = suspected.copy()
    suspected[58:63, 0] = True
    complete[58:63, 0] = np.linspace(samples[57, 0], samples[63, 0], 7)[1:-1]

    confirmed = confirm_outliers(samples, suspected, complete, 30.0, MIXTURE)

    assert (confirmed == expected).all()


def test_second_error_of_a_take_need_not_be_as_likely_as_the_first(rng):
    fast_kick = out_of_stillness(2.0 * KICK, rng)
    samples = np.hstack([fast_kick, 0.1 * rng.normal(size=fast_kick.shape)])
    suspected = np.tile(abs(TIME)[:, None] < 0.1, 6)
    suspected[:, 3:] = False
    complete = np.where(suspected, samples[:1], samples)
    assert not confirm_outliers(samples, suspected, complete, 30.0, MIXTURE).any()

    samples[5:10, 3:] += 60.0
    suspected[5:10, 3:] = True

    assert (confirm_outliers(samples, suspected, complete, 30.0, MIXTURE) == suspected).all()


@pytest.mark.parametrize("tested", [[True, False, False], [True, True, True]])
def test_density_of_the_others_needs_no_factorization_of_its_own(tested, rng):
    samples, valid = (
        np.cumsum(5.0 * rng.normal(size=(16, 3)), axis=0),
        rng.random((16, 3)) > 0.2,
    )
    valid[8] = True
    windows = Windows(16, MIXTURE.window, 1.0)
    noise, axes = np.array([2.0, 2.5, 3.0]), np.linalg.qr(rng.normal(size=(3, 3)))[0]
    predictive = PredictiveDensity(samples, noise, windows, MIXTURE, axes)

    density = predictive.of_run(slice(8, 9), np.array(tested), valid)
    others = density.valid & ~density.tested
    both, alone = (
        density.density.log_marginals(density.samples, density.channels, known)[0]
        for known in (density.valid, others)
    )

    continued = np.logaddexp.reduce(both) - np.logaddexp.reduce(alone)
    begun = np.log(NEW_MOVEMENT_RATE) + np.logaddexp.reduce(
        np.log(MIXTURE.weights) + both - alone
    )
    assert density.as_movement == pytest.approx(np.logaddexp(continued, begun), abs=1e-9)


@pytest.mark.parametrize("rate", [30.0, 1000.0])
def test_matrix_of_a_window_does_not_grow_with_the_frame_rate(rate, rng, monkeypatch):
    """A gap of 0.3 s at 1000 Hz took 7 s and 2 GB for each error next to it."""
    length = round(MIXTURE.window * rate / MIXTURE.frame_rate)
    windows = Windows(length, length, rate / MIXTURE.frame_rate)
    samples = 10.0 * rng.normal(size=(length, 3))
    valid = np.tile(np.arange(length)[:, None] > 0.6 * length, 3)
    sizes, cholesky = [], np.linalg.cholesky
    monkeypatch.setattr(
        np.linalg, "cholesky", lambda each: sizes.append(each.shape[-1]) or cholesky(each)
    )

    predictive = PredictiveDensity(samples, np.full(3, 2.0), windows, MIXTURE, np.eye(3))
    density = predictive.of_run(slice(length - 3, length), np.ones(3, bool), valid)

    assert np.isfinite(density.as_movement)
    assert max(sizes) <= 3 * MIXTURE.window + 4


def interpolate(samples: np.ndarray, suspected: np.ndarray) -> np.ndarray:
    """The samples with straight lines where they are suspected."""
    complete = samples.copy()
    for column, is_suspected in zip(complete.T, suspected.T, strict=True):
        right = np.flatnonzero(~is_suspected)
        column[is_suspected] = np.interp(np.flatnonzero(is_suspected), right, column[right])
    return complete


@pytest.mark.parametrize("wrong", [[50, 51], [50, 54], [50, 51, 54], [50, 52, 53, 54]])
def test_right_frames_between_spikes_are_kept_where_spikes_are_frequent(wrong, rng):
    samples = walk_like(30.0, rng)
    errors = np.zeros(samples.shape, dtype=bool)
    errors[3:110:4, 4] = errors[2:110:5, 5] = True
    errors[wrong, 1] = True
    samples += errors * 40.0 * rng.choice([-1.0, 1.0], size=samples.shape)
    suspected = errors.copy()
    suspected[50:55, 1] = True

    confirmed = confirm_outliers(
        samples, suspected, interpolate(samples, suspected), 30.0, MIXTURE
    )

    assert (confirmed == errors).all()


def test_unrelated_frames_are_one_error_where_there_are_no_spikes(rng):
    samples = walk_like(30.0, rng)
    samples[50:55, 1] += [40.0, -30.0, 0.0, 50.0, -40.0]
    suspected = np.zeros(samples.shape, dtype=bool)
    suspected[50:55, 1] = True

    confirmed = confirm_outliers(
        samples, suspected, interpolate(samples, suspected), 30.0, MIXTURE
    )

    assert (confirmed == suspected).all()


def test_density_of_all_tested_samples_is_that_of_the_run_and_of_none_is_one(rng):
    samples = np.cumsum(5.0 * rng.normal(size=(16, 3)), axis=0)
    windows = Windows(16, MIXTURE.window, 1.0)
    predictive = PredictiveDensity(samples, np.full(3, 2.0), windows, MIXTURE, np.eye(3))

    density = predictive.of_run(slice(6, 9), np.array([True, True, False]), samples < np.inf)

    assert density.movement_of(density.tested) == pytest.approx(density.as_movement, abs=1e-9)
    nothing = density.movement_of(np.zeros_like(density.tested))
    assert nothing == pytest.approx(np.log1p(NEW_MOVEMENT_RATE), abs=1e-9)


@pytest.mark.parametrize("rate", [1e-6, 0.01, 0.1, 0.25])
def test_rate_of_spikes_follows_from_that_of_isolated_ones(rate, rng):
    wrong = rng.random(400_000) < rate
    isolated = wrong[1:-1] & ~wrong[:-2] & ~wrong[2:]
    expected = isolated.mean() if rate > 1e-3 else rate

    assert np.exp(_with_adjacent(np.log(expected))) == pytest.approx(rate, rel=0.05)
