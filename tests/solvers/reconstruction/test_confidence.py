"""Calibrate the confidence of residual priors for actors outside the training set."""

from dataclasses import replace

import numpy as np
import pytest
from bad_sensor import KNEE, SMALL_PRIOR, pair, recording, simulate_bad_sensor, truth
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.reconstruction import correct_postures, learn_residual_prior, load_residual_prior
from solvers.reconstruction.residual_correction.confidence import (
    IDENTITY_CALIBRATION,
    Calibration,
    probability_within,
)
from solvers.reconstruction.residual_correction.learn_confidence import (
    calibrate_confidence,
    fit_calibration,
    with_calibration,
)
from solvers.reconstruction.residual_correction.residual_prior import LAYOUT

ACTORS = ("anna", "anna", "bob", "carla")


@pytest.fixture(scope="module")
def pairs():
    return [
        pair(truth(speed), off) for speed, off in ((0.9, 0), (1.2, 0), (1.4, 0.06), (1.6, 0.03))
    ]


@pytest.fixture(scope="module")
def prior(pairs):
    return learn_residual_prior(pairs, actors=ACTORS, settings=SMALL_PRIOR)


def test_probability_integrates_over_an_unknown_variance(rng):
    """Compare with Monte Carlo: draw a variance of an actor, then an error."""
    spread = 0.9
    deviation = 0.03 * np.exp(0.5 * spread * rng.normal(size=400_000))
    drawn = np.linalg.norm(rng.normal(size=(400_000, 3)), axis=-1) * deviation

    probability = probability_within(np.array(0.03**2), 0.05, Calibration(spread=spread))

    assert probability == pytest.approx((drawn < 0.05).mean(), abs=0.005)


def test_differences_between_joints_shrink_toward_their_level():
    level = np.log(0.03**2)
    variances = np.exp(level + np.array([-1.0, 0.0, 1.0]))

    probability = probability_within(variances, 0.05, Calibration(0.0, 0.5, 0.0))

    assert_allclose(
        probability, probability_within(np.exp(level + np.array([-0.5, 0.0, 0.5])), 0.05)
    )


@pytest.mark.parametrize("slope", [0.0, 0.5, 1.0])
def test_calibration_of_unknown_variances_has_no_confidence(slope):
    assert probability_within(np.array(np.inf), 0.05, Calibration(0.0, slope, 1.0)) == 0.0


def test_calibration_recovers_slope_and_spread_of_held_out_actors(rng):
    log_variances = rng.normal(-7.0, 1.0, 4000)
    found = -7.0 + 0.6 * (log_variances + 7.0) + rng.normal(scale=0.8, size=4000)
    gaps = np.full((5, 2), np.nan)

    points = np.concatenate([np.stack([log_variances, found], axis=-1), gaps])
    shift, slope, spread = fit_calibration(points, keep_level=True)

    assert shift == 0.0
    assert slope == pytest.approx(0.6, abs=0.04)
    assert spread == pytest.approx(0.8, abs=0.03)


def test_larger_errors_of_all_actors_widen_the_spread_at_equal_level():
    log_variances = np.linspace(-8.0, -6.0, 50)

    fitted = fit_calibration(
        np.stack([log_variances, log_variances + 0.7], axis=-1), keep_level=True
    )

    assert fitted == pytest.approx((0.0, 1.0, 0.7))


def test_without_constant_offset_the_level_is_learned():
    log_variances = np.linspace(-8.0, -6.0, 50)

    learned = fit_calibration(
        np.stack([log_variances, log_variances - 1.8], axis=-1), keep_level=False
    )

    assert learned == pytest.approx((-1.8, 1.0, 0.0), abs=1e-9)


def test_confidence_is_calibrated_for_new_actors_at_any_error_size(rng):
    """The expected fraction of errors lies within the distance; without calibration it is
    smaller.
    """
    training, new = (np.exp(0.5 * 1.2 * rng.normal(size=n)) for n in (60, 400))
    variances = np.exp(rng.normal(-7.6, 0.4, size=20))
    points = [
        np.stack([np.log(variances), np.log(variances) + 2.0 * np.log(each)], axis=-1)
        for each in training
    ]
    errors = (
        rng.normal(size=(400, 20, 50, 3)) * (new[:, None] * np.sqrt(variances))[..., None, None]
    )
    right = (np.linalg.norm(errors, axis=-1) < 0.05).mean(axis=(0, 2))

    plain, calibrated = (
        probability_within(variances, 0.05, each)
        for each in (
            IDENTITY_CALIBRATION,
            fit_calibration(np.concatenate(points), keep_level=True),
        )
    )

    assert np.abs(calibrated - right).max() < 0.06
    assert (plain - right).max() > 0.1


def test_calibration_from_held_out_actors_is_saved_in_the_file(prior, pairs, tmp_path):
    calibrated = calibrate_confidence(prior, pairs, ACTORS, settings=SMALL_PRIOR)
    calibrated.save(tmp_path / "prior.npz")
    again = load_residual_prior(tmp_path / "prior.npz")

    assert_allclose(again.calibration, calibrated.calibration)
    assert (calibrated.calibration[:, 2] > 0.0).all()
    take = recording(simulate_bad_sensor(truth(1.3)))
    before, after = (correct_postures(take, each) for each in (prior, again))
    assert_allclose(after.tracks.positions, before.tracks.positions)
    knee = [each.confidence[:, KNEE].mean() for each in (before, after)]
    assert knee[1] < knee[0] - 0.02


def test_older_files_have_an_identity_calibration(prior, tmp_path):
    path = tmp_path / "prior.npz"
    prior.save(path)
    arrays = LAYOUT.read(path)
    del arrays["calibration"]
    LAYOUT.write(path, arrays)

    assert_allclose(
        load_residual_prior(path).calibration, [IDENTITY_CALIBRATION, IDENTITY_CALIBRATION]
    )


def test_load_raises_for_an_invalid_calibration(prior, tmp_path):
    replace(prior, calibration=-np.ones((2, 3))).save(tmp_path / "prior.npz")

    with pytest.raises(InvalidFileError, match="calibration is negative"):
        load_residual_prior(tmp_path / "prior.npz")


def test_calibrate_confidence_raises_for_two_actors(prior, pairs):
    with pytest.raises(InvalidMotionError, match="needs 3; there are 2"):
        calibrate_confidence(prior, pairs, ("anna", "anna", "bob", "bob"), settings=SMALL_PRIOR)


def test_calibration_without_measurements_is_the_identity(prior):
    nothing = np.full((2, 20, 2), np.nan)

    assert_allclose(
        with_calibration(prior, [nothing]).calibration,
        [IDENTITY_CALIBRATION, IDENTITY_CALIBRATION],
    )
