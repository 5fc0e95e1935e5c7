"""The smooth trajectory follows the motion, and deviations from it are spikes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.signals.spikes import find_runs, fit_lowess


def test_parabola_has_no_residual(rng):
    time = np.arange(60.0)[:, None]
    trajectory = rng.normal(size=3) + rng.normal(size=3) * time + rng.normal(size=3) * time**2

    result = fit_lowess(trajectory, 4, min_scale=1e-3)

    assert_allclose(result.residual, 0.0, atol=1e-7)
    assert result.scale < 1e-7


def test_two_frames_contain_no_spike():
    """A line passes through both, however far apart they are."""
    result = fit_lowess(np.array([[0.0, 0.0], [3.0, 1.0]]), 4, min_scale=0.1)

    assert_allclose(result.residual, 0.0)
    assert not result.spikes(0.1).any()


def test_gaps_do_not_affect_other_frames():
    trajectory = np.sin(np.arange(200.0) / 20.0)[:, None] * [1.0, 0.5, 0.2]
    gapped = trajectory.copy()
    gapped[50:53] = np.nan

    result = fit_lowess(gapped, 5, min_scale=0.1)

    assert np.isnan(result.residual[50:53]).all()
    assert np.nanmax(result.deviation) < 0.01
    assert not result.spikes(0.1).any()


@pytest.mark.parametrize("length", [1, 2, 3])
def test_all_frames_of_a_spike_and_its_height_are_found(rng, length):
    trajectory = np.sin(np.arange(300.0) / 30.0)[:, None] * np.ones(3)
    trajectory += rng.normal(scale=0.01, size=trajectory.shape)
    trajectory[100 : 100 + length] += [0.5, 0.0, 0.0]

    result = fit_lowess(trajectory, 8, min_scale=0.05)

    assert find_runs(result.spikes(0.1)) == [(100, 100 + length)]
    assert_allclose(result.deviation[100 : 100 + length], 0.5, atol=0.06)


def test_noise_estimate_ignores_spikes_and_motion(rng):
    trajectory = np.sin(np.arange(3000.0) / 15.0)[:, None] * np.ones(3)
    trajectory += rng.normal(scale=0.02, size=trajectory.shape)
    hit = rng.random(3000) < 0.2
    trajectory[hit] += rng.normal(size=(hit.sum(), 3))

    assert_allclose(fit_lowess(trajectory, 8, min_scale=0.05).scale, 0.02, rtol=0.25)


def test_fast_movement_is_no_spike():
    """A knee extends and stops within a tenth of a second, at 120 Hz."""
    time = np.arange(120) / 120.0
    trajectory = np.exp(-(((time - 0.5) / 0.05) ** 2))[:, None] * [1.0, 0.0, 0.0]

    assert not fit_lowess(trajectory, 14, min_scale=0.1).spikes(0.1).any()


@pytest.mark.parametrize(("swings_per_s", "size"), [(4, 0.3), (5, 0.3)])
def test_swing_within_a_few_frames_is_no_spike(swings_per_s, size):
    """A hand waves for half a second, at 30 Hz."""
    time = np.arange(90) / 30.0
    swing = np.sin(2.0 * np.pi * swings_per_s * time) * np.exp(-(((time - 1.5) / 0.25) ** 2))

    assert not fit_lowess(size * swing[:, None], 4, min_scale=0.14).spikes(0.14).any()


def test_spike_beside_a_gap_and_at_the_end_is_found():
    trajectory = np.sin(np.arange(60.0) / 10.0)[:, None] * np.ones(3)
    trajectory[[0, 30, 59]] += [0.8, 0.0, 0.0]
    trajectory[31:34] = np.nan

    found = fit_lowess(trajectory, 5, min_scale=0.1).spikes(0.3)

    assert find_runs(found) == [(0, 1), (30, 31), (59, 60)]


@pytest.mark.parametrize("seed", range(8))
def test_lasting_change_is_no_spike(seed):
    """A cut between two takes jumps and does not return."""
    noise = np.random.default_rng(seed).normal(scale=0.01, size=(300, 3))
    trajectory = np.sin(np.arange(300.0) / 30.0)[:, None] + noise
    trajectory[150:] += [0.5, 0.0, 0.0]

    assert not fit_lowess(trajectory, 8, min_scale=0.05).spikes(0.1).any()


def test_spikes_are_found_if_a_third_of_all_frames_are_spikes(rng):
    trajectory = np.sin(np.arange(1200) / 15.0)[:, None] + rng.normal(
        scale=0.02, size=(1200, 3)
    )
    hit = rng.random(1200) < 0.33
    trajectory[hit] += rng.normal(scale=0.8, size=(hit.sum(), 3))

    found = fit_lowess(trajectory, 8, min_scale=0.05).spikes(0.15)

    assert (found & hit).sum() > 0.75 * hit.sum()
    assert (found & ~hit).sum() < 0.01 * (~hit).sum()


def test_runs_are_half_open():
    assert find_runs(np.array([True, True, False, True])) == [(0, 2), (3, 4)]
    assert find_runs(np.zeros(3, dtype=bool)) == []
