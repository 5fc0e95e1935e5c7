"""Outliers must be found however many there are, and whatever the noise."""

import numpy as np
import pytest
from scipy.ndimage import median_filter

from solvers.denoising import denoise
from solvers.denoising.outliers import fit_inlier_probability, outlier_rate
from solvers.denoising.window_estimates.estimate_channels import estimate_channels
from solvers.denoising.window_estimates.prior_selection import build_take_prior
from solvers.denoising.window_estimates.rough_take import RoughTake
from solvers.denoising.window_priors import Windows
from solvers.recordings import read_bvh

SIZES_DEG = (20.0, 60.0)


def outlying(shape, rng):
    return rng.uniform(*SIZES_DEG, size=shape) * rng.choice([-1, 1], size=shape)


@pytest.mark.parametrize("fraction", [0.0, 0.1, 0.4])
def test_outliers_are_found_though_the_noise_is_unknown(fraction, rng):
    noise, n_outliers = np.array([1.0, 4.0]), round(300 * fraction)
    errors = noise * rng.normal(size=(300, 2))
    errors[:n_outliers] = outlying((n_outliers, 2), rng)

    found = fit_inlier_probability(
        errors, np.full((300, 2), 0.1), np.ones((300, 2), dtype=bool), 0.01
    )

    assert (found[:n_outliers] < 0.5).all()
    assert (found[n_outliers:] > 0.5).mean() > 0.97


def test_samples_that_are_known_to_be_wrong_do_not_count(rng):
    errors, is_valid = rng.normal(size=(100, 3)), np.ones((100, 3), dtype=bool)
    errors[:60, 1] = 50.0
    is_valid[:60, 1] = is_valid[:, 2] = False

    found = fit_inlier_probability(errors, np.full((100, 3), 0.1), is_valid, 0.01)

    assert not found[~is_valid].any()
    assert outlier_rate(found, is_valid) < 0.05
    assert outlier_rate(found, np.zeros_like(is_valid)) < 0.05


def test_noise_that_is_given_far_too_large_does_not_hide_outliers(rng):
    """In 40 % of outliers, differences of neighbors show five times the noise."""
    phases = np.linspace(0.0, 6.0, 12)
    truth = 20.0 * np.sin(np.arange(200)[:, None] / 5.0 + phases)
    is_outlier = rng.random(truth.shape) < 0.4
    noisy = truth + np.where(
        is_outlier, outlying(truth.shape, rng), rng.normal(size=truth.shape)
    )
    noise, windows = np.full(12, 15.0), Windows(200, 30, 1.0)
    start = median_filter(noisy, (9, 1))
    prior = build_take_prior(start, noise, np.ones(12, dtype=bool), windows, 30, 30.0)
    no_errors = np.zeros(noisy.shape, dtype=bool)
    take = RoughTake(noisy, no_errors, start, noise, np.full(12, 200), windows)

    estimate = estimate_channels(take, prior)

    assert (estimate.inliers < 0.5)[is_outlier].mean() > 0.9
    assert np.abs(estimate.values - truth).mean() < 6.0
    assert estimate.converged
    assert not estimate_channels(take, prior, max_iterations=1).converged


def test_invisible_changes_are_not_reported(recordings):
    """A run at 30 Hz still changes by 0.02 degrees in the last of 30 iterations."""
    path = recordings / "corpus" / "bvh" / "bandai_namco" / "dataset-1_run_angry_001.bvh"

    assert denoise(read_bvh(path)).converged
