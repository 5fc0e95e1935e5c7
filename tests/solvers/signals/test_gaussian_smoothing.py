"""Centered and causal Gaussian smoothing and gap filling."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.motion.humanoid.posture_joints import N_JOINTS
from solvers.signals.gaussian_smoothing import (
    CausalSmoother,
    smooth_gaussian,
    smooth_to_the_ends,
)
from solvers.signals.linear_gaps import fill_gaps


@pytest.fixture
def random():
    return np.random.default_rng(7)


def test_centered_smoothing_equals_a_gaussian(random):
    values = random.normal(size=(50, 3, 2))
    np.testing.assert_allclose(
        smooth_gaussian(values, 2.5), gaussian_filter1d(values, 2.5, axis=0, mode="nearest")
    )


def test_causal_smoothing_equals_half_a_gaussian(random):
    values, width = random.normal(size=40), 2.0
    weights = np.exp(-0.5 * (np.arange(9) / width) ** 2)
    by_hand = [
        sum(
            weight * values[max(frame - lag, 0)]
            for lag, weight in enumerate(weights / weights.sum())
        )
        for frame in range(40)
    ]
    np.testing.assert_allclose(smooth_gaussian(values, width, causal=True), by_hand)


def test_causal_smoothing_ignores_later_frames(random):
    values = random.normal(size=(60, 4))
    changed = values.copy()
    changed[30:] = 9.0
    one, other = (smooth_gaussian(each, 3.0, causal=True) for each in (values, changed))
    np.testing.assert_array_equal(one[:30], other[:30])


@pytest.mark.parametrize("causal", [True, False])
def test_constants_and_width_zero_stay_unchanged(causal, random):
    still = np.full((20, 2), 3.5)
    np.testing.assert_allclose(smooth_gaussian(still, 4.0, causal=causal), still)
    values = random.normal(size=(20, 2))
    np.testing.assert_array_equal(smooth_gaussian(values, 0.0, causal=causal), values)


def test_ramp_lags_by_the_mean_of_half_a_gaussian():
    ramp, width = np.arange(200.0), 10.0
    assert ramp[150] - smooth_gaussian(ramp, width, causal=True)[150] == pytest.approx(
        width * np.sqrt(2.0 / np.pi), rel=0.07
    )


def test_causal_gaps_hold_the_last_observed_value():
    observed = np.array([np.nan, 1.0, np.nan, np.nan, 4.0, np.nan])[:, None]
    np.testing.assert_allclose(fill_gaps(observed)[:, 0], [1.0, 1.0, 2.0, 3.0, 4.0, 4.0])
    np.testing.assert_allclose(
        fill_gaps(observed, causal=True)[:, 0], [1.0, 1.0, 1.0, 1.0, 4.0, 4.0]
    )
    assert np.isnan(fill_gaps(np.full((3, 2), np.nan), causal=True)).all()


def test_causal_headings_ignore_later_frames(random):
    takes = random.normal(size=(2, 60, N_JOINTS, 3))
    takes[1, :40] = takes[0, :40]
    one, other = (normalize_postures(take, 30.0, causal=True) for take in takes)
    np.testing.assert_array_equal(one.headings[:40], other.headings[:40])
    np.testing.assert_array_equal(one.postures[:40], other.postures[:40])
    one, other = (normalize_postures(take, 30.0) for take in takes)
    assert (one.headings[:40] != other.headings[:40]).any()


def test_frame_by_frame_is_the_same(random):
    values = random.normal(size=(50, 3))
    smoother = CausalSmoother(3.0)
    found = [smoother.update(each) for each in values]
    np.testing.assert_allclose(found, smooth_gaussian(values, 3.0, causal=True), atol=1e-12)


def test_a_walk_keeps_its_speed_at_the_ends_of_its_clip():
    path = 0.01 * np.arange(30.0)[:, None] * (1.0, -2.0)

    np.testing.assert_allclose(smooth_to_the_ends(path, 3.0), path, atol=1e-12)
