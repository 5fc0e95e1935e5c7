"""Confidence holds for people whom the prior has never seen."""

from dataclasses import replace

import numpy as np
import pytest
from bad_sensor import KNEE, QUICK, pair, recording, seen_by_a_bad_sensor, truth
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
from solvers.reconstruction.residual_correction.prior import LAYOUT

ACTORS = ("anna", "anna", "bob", "carla")


@pytest.fixture(scope="module")
def pairs():
    return [
        pair(truth(speed), off) for speed, off in ((0.9, 0), (1.2, 0), (1.4, 0.06), (1.6, 0.03))
    ]


@pytest.fixture(scope="module")
def prior(pairs):
    return learn_residual_prior(pairs, actors=ACTORS, settings=QUICK)


def test_an_unknown_variance_is_averaged_over(rng):
    """Second way: draw somebody's variance, then his error."""
    spread = 0.9
    deviation = 0.03 * np.exp(0.5 * spread * rng.normal(size=400_000))
    drawn = np.linalg.norm(rng.normal(size=(400_000, 3)), axis=-1) * deviation

    told = probability_within(np.array(0.03**2), 0.05, Calibration(spread=spread))

    assert told == pytest.approx((drawn < 0.05).mean(), abs=0.005)


def test_differences_between_joints_shrink_toward_their_level():
    level = np.log(0.03**2)
    variances = np.exp(level + np.array([-1.0, 0.0, 1.0]))

    told = probability_within(variances, 0.05, Calibration(0.0, 0.5, 0.0))

    assert_allclose(told, probability_within(np.exp(level + np.array([-0.5, 0.0, 0.5])), 0.05))


@pytest.mark.parametrize("slope", [0.0, 0.5, 1.0])
def test_calibration_of_unknown_variances_has_no_confidence(slope):
    assert probability_within(np.array(np.inf), 0.05, Calibration(0.0, slope, 1.0)) == 0.0


def test_slope_and_spread_are_those_of_actors_who_were_left_out(rng):
    told = rng.normal(-7.0, 1.0, 4000)
    found = -7.0 + 0.6 * (told + 7.0) + rng.normal(scale=0.8, size=4000)
    gaps = np.full((5, 2), np.nan)

    points = np.concatenate([np.stack([told, found], axis=-1), gaps])
    shift, slope, spread = fit_calibration(points, keep_level=True)

    assert shift == 0.0
    assert slope == pytest.approx(0.6, abs=0.04)
    assert spread == pytest.approx(0.8, abs=0.03)


def test_those_who_all_err_more_widen_the_spread_and_leave_the_level():
    told = np.linspace(-8.0, -6.0, 50)

    kept = fit_calibration(np.stack([told, told + 0.7], axis=-1), keep_level=True)

    assert kept == pytest.approx((0.0, 1.0, 0.7))


def test_without_constant_offset_the_level_is_learned():
    told = np.linspace(-8.0, -6.0, 50)

    learned = fit_calibration(np.stack([told, told - 1.8], axis=-1), keep_level=False)

    assert learned == pytest.approx((-1.8, 1.0, 0.0), abs=1e-9)


def test_confidence_is_right_of_new_actors_whose_sensors_err_by_any_amount(rng):
    """As many as are told lie within; without a calibration too few of the surest do."""
    known, new = (np.exp(0.5 * 1.2 * rng.normal(size=n)) for n in (60, 400))
    variances = np.exp(rng.normal(-7.6, 0.4, size=20))
    points = [
        np.stack([np.log(variances), np.log(variances) + 2.0 * np.log(each)], axis=-1)
        for each in known
    ]
    off = (
        rng.normal(size=(400, 20, 50, 3)) * (new[:, None] * np.sqrt(variances))[..., None, None]
    )
    right = (np.linalg.norm(off, axis=-1) < 0.05).mean(axis=(0, 2))

    plain, told = (
        probability_within(variances, 0.05, each)
        for each in (
            IDENTITY_CALIBRATION,
            fit_calibration(np.concatenate(points), keep_level=True),
        )
    )

    assert np.abs(told - right).max() < 0.06
    assert (plain - right).max() > 0.1


def test_a_calibration_is_learned_by_leaving_actors_out_and_kept_in_the_file(
    prior, pairs, tmp_path
):
    told = calibrate_confidence(prior, pairs, ACTORS, settings=QUICK)
    told.save(tmp_path / "prior.npz")
    again = load_residual_prior(tmp_path / "prior.npz")

    assert_allclose(again.calibration, told.calibration)
    assert (told.calibration[:, 2] > 0.0).all()
    take = recording(seen_by_a_bad_sensor(truth(1.3)))
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


def test_a_calibration_that_cannot_be_is_refused(prior, tmp_path):
    replace(prior, calibration=-np.ones((2, 3))).save(tmp_path / "prior.npz")

    with pytest.raises(InvalidFileError, match="calibration is negative"):
        load_residual_prior(tmp_path / "prior.npz")


def test_two_actors_are_too_few(prior, pairs):
    with pytest.raises(InvalidMotionError, match="needs 3; there are 2"):
        calibrate_confidence(prior, pairs, ("anna", "anna", "bob", "bob"), settings=QUICK)


def test_calibration_of_no_measurement_is_the_identity(prior):
    nothing = np.full((2, 20, 2), np.nan)

    assert_allclose(
        with_calibration(prior, [nothing]).calibration,
        [IDENTITY_CALIBRATION, IDENTITY_CALIBRATION],
    )
