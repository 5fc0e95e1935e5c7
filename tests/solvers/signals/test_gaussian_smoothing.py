"""Steadying with and without a look at what comes, and gaps bridged the same two ways."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.motion.humanoid.posture_joints import N_JOINTS
from solvers.signals.gaussian_smoothing import smooth_gaussian
from solvers.signals.linear_gaps import fill_gaps


@pytest.fixture
def random():
    return np.random.default_rng(7)


def test_with_a_look_ahead_it_is_the_gaussian(random):
    values = random.normal(size=(50, 3, 2))
    np.testing.assert_allclose(
        smooth_gaussian(values, 2.5), gaussian_filter1d(values, 2.5, axis=0, mode="nearest")
    )


def test_without_it_half_the_gaussian_as_written_down(random):
    values, width = random.normal(size=40), 2.0
    weights = np.exp(-0.5 * (np.arange(9) / width) ** 2)
    by_hand = [
        sum(
            weight * values[max(frame - lag, 0)]
            for lag, weight in enumerate(weights / weights.sum())
        )
        for frame in range(40)
    ]
    np.testing.assert_allclose(smooth_gaussian(values, width, ahead=False), by_hand)


def test_what_comes_later_changes_nothing_before_it(random):
    values = random.normal(size=(60, 4))
    changed = values.copy()
    changed[30:] = 9.0
    one, other = (smooth_gaussian(each, 3.0, ahead=False) for each in (values, changed))
    np.testing.assert_array_equal(one[:30], other[:30])


@pytest.mark.parametrize("ahead", [True, False])
def test_what_does_not_move_stays_and_no_width_changes_nothing(ahead, random):
    still = np.full((20, 2), 3.5)
    np.testing.assert_allclose(smooth_gaussian(still, 4.0, ahead=ahead), still)
    values = random.normal(size=(20, 2))
    np.testing.assert_array_equal(smooth_gaussian(values, 0.0, ahead=ahead), values)


def test_a_ramp_lags_behind_by_the_mean_of_half_a_gaussian():
    ramp, width = np.arange(200.0), 10.0
    assert ramp[150] - smooth_gaussian(ramp, width, ahead=False)[150] == pytest.approx(
        width * np.sqrt(2.0 / np.pi), rel=0.07
    )


def test_gaps_hold_what_was_known_last_where_nothing_is_known_of_what_comes():
    seen = np.array([np.nan, 1.0, np.nan, np.nan, 4.0, np.nan])[:, None]
    np.testing.assert_allclose(fill_gaps(seen)[:, 0], [1.0, 1.0, 2.0, 3.0, 4.0, 4.0])
    np.testing.assert_allclose(
        fill_gaps(seen, ahead=False)[:, 0], [1.0, 1.0, 1.0, 1.0, 4.0, 4.0]
    )
    assert np.isnan(fill_gaps(np.full((3, 2), np.nan), ahead=False)).all()


def test_headings_that_do_not_look_ahead_know_nothing_of_what_comes(random):
    takes = random.normal(size=(2, 60, N_JOINTS, 3))
    takes[1, :40] = takes[0, :40]
    one, other = (normalize_postures(take, 30.0, ahead=False) for take in takes)
    np.testing.assert_array_equal(one.headings[:40], other.headings[:40])
    np.testing.assert_array_equal(one.postures[:40], other.postures[:40])
    one, other = (normalize_postures(take, 30.0) for take in takes)
    assert (one.headings[:40] != other.headings[:40]).any()
