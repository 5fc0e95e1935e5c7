"""A smooth course must be followed, and what jumps off it must be seen."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.quality.joint_signals import estimate_local_noise
from solvers.signals.spikes import find_runs, fit_lowess


def test_a_parabola_has_no_residual_even_at_its_ends(rng):
    time = np.arange(60.0)[:, None]
    course = rng.normal(size=3) + rng.normal(size=3) * time + rng.normal(size=3) * time**2

    told = fit_lowess(course, 4, min_scale=1e-3)

    assert_allclose(told.residual, 0.0, atol=1e-7)
    assert told.scale < 1e-7


def test_gaps_disturb_nothing_else():
    course = np.sin(np.arange(200.0) / 20.0)[:, None] * [1.0, 0.5, 0.2]
    gapped = course.copy()
    gapped[50:53] = np.nan

    told = fit_lowess(gapped, 5, min_scale=0.1)

    assert np.isnan(told.residual[50:53]).all()
    assert np.nanmax(told.deviation) < 0.01
    assert not told.spikes(0.1).any()


@pytest.mark.parametrize("length", [1, 2, 3])
def test_a_spike_is_found_whole_and_with_its_height(rng, length):
    course = np.sin(np.arange(300.0) / 30.0)[:, None] * np.ones(3)
    course += rng.normal(scale=0.01, size=course.shape)
    course[100 : 100 + length] += [0.5, 0.0, 0.0]

    told = fit_lowess(course, 8, min_scale=0.05)

    assert find_runs(told.spikes(0.1)) == [(100, 100 + length)]
    assert_allclose(told.deviation[100 : 100 + length], 0.5, atol=0.06)


def test_the_noise_is_measured_through_spikes_and_motion(rng):
    course = np.sin(np.arange(3000.0) / 15.0)[:, None] * np.ones(3)
    course += rng.normal(scale=0.02, size=course.shape)
    hit = rng.random(3000) < 0.2
    course[hit] += rng.normal(size=(hit.sum(), 3))

    assert_allclose(fit_lowess(course, 8, min_scale=0.05).scale, 0.02, rtol=0.25)


def test_a_quick_but_honest_movement_is_no_spike():
    """A knee that extends and stops within a tenth of a second, at 120 Hz."""
    time = np.arange(120) / 120.0
    course = np.exp(-(((time - 0.5) / 0.05) ** 2))[:, None] * [1.0, 0.0, 0.0]

    assert not fit_lowess(course, 14, min_scale=0.1).spikes(0.1).any()


@pytest.mark.parametrize("seed", range(8))
def test_a_lasting_change_is_no_spike(seed):
    """A cut between two takes jumps, but not back."""
    noise = np.random.default_rng(seed).normal(scale=0.01, size=(300, 3))
    course = np.sin(np.arange(300.0) / 30.0)[:, None] + noise
    course[150:] += [0.5, 0.0, 0.0]

    assert not fit_lowess(course, 8, min_scale=0.05).spikes(0.1).any()


def test_spikes_are_told_apart_where_a_third_of_the_frames_are_spikes(rng):
    course = np.sin(np.arange(1200) / 15.0)[:, None] + rng.normal(scale=0.02, size=(1200, 3))
    hit = rng.random(1200) < 0.33
    course[hit] += rng.normal(scale=0.8, size=(hit.sum(), 3))

    found = fit_lowess(course, 8, min_scale=0.05).spikes(0.15)

    assert (found & hit).sum() > 0.75 * hit.sum()
    assert (found & ~hit).sum() < 0.01 * (~hit).sum()


def test_shaking_is_where_the_noise_is(rng):
    """White noise of known size in the second half of a 2 Hz swing sampled at 30 Hz."""
    time = np.arange(600) / 30.0
    course = np.sin(2 * np.pi * 2.0 * time)[:, None] * [1.0, 0.0, 0.0]
    course[300:] += rng.normal(scale=0.05, size=(300, 3))

    shake = estimate_local_noise(course, 30)

    assert shake[:280].max() == 0.0
    assert_allclose(np.median(shake[320:]), 0.05, rtol=0.2)


def test_runs_are_half_open():
    assert find_runs(np.array([True, True, False, True])) == [(0, 2), (3, 4)]
    assert find_runs(np.zeros(3, dtype=bool)) == []
