"""Where theory is exact, the default method must be exact."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.window_estimates.covariance import covariance_from_prior
from solvers.denoising.window_estimates.filters import (
    Filter,
    build_filters,
    compute_gains,
    compute_variance,
    sum_covariances,
    sum_window_weights,
)
from solvers.denoising.window_estimates.gap_patterns import (
    GapSolution,
    find_gap_patterns,
    find_long_gaps,
)
from solvers.denoising.window_priors import SmoothPrior, WindowPrior, Windows

LENGTH, N_SLOW, N_CHANNELS = 8, 5, 3


def test_window_with_gaps_equals_the_conditional_gaussian(rng):
    """The reference is one dense system over the observed samples."""
    windows = Windows(LENGTH, LENGTH, 1.0)
    slow = random_covariance(rng)
    noise = np.array([0.3, 0.5, 0.4])
    truth = frames_from(windows, rng.multivariate_normal(np.zeros(len(slow)), slow))
    noisy = truth + rng.normal(size=truth.shape) * noise
    noisy[2:6, 1] = np.nan
    noisy[:4, 2] = np.nan
    (pattern,) = find_gap_patterns(np.isfinite(noisy), windows, N_SLOW)
    gains = compute_gains(slow, np.zeros((LENGTH - N_SLOW, N_CHANNELS)), noise, 1.0)
    solution = GapSolution.solve(pattern, gains.slow)
    observed = windows.coefficients_from_frames(
        pattern.mask_frames(np.nan_to_num(noisy)[None])
    )[:, :N_SLOW]

    coefficients = solution.posterior_mean((observed / noise).reshape(1, -1), pattern.indices)[
        0
    ]
    estimate = frames_from(windows, coefficients * np.tile(noise, N_SLOW))

    mean, variance = dense_posterior(windows, slow, noise, noisy)
    assert_allclose(estimate, mean, atol=1e-9)
    filters = [Filter(pattern, gains, solution)]
    actual_variance, leverage = compute_variance(filters, windows, noisy)
    assert_allclose(actual_variance[:, 1:], variance[:, 1:], atol=1e-9)
    assert_allclose(leverage[:, 1:], variance[:, 1:] / noise[1:] ** 2, atol=1e-9)
    covariance = sum_covariances(filters)
    assert_allclose(frame_variance(windows, covariance)[:, 1:], variance[:, 1:], atol=1e-9)


@pytest.mark.parametrize("independent", [False, True])
def test_gains_are_those_of_the_plain_formula(independent, rng):
    slow = random_covariance(rng)
    if independent:
        slow *= np.tile(np.eye(N_CHANNELS), (N_SLOW, N_SLOW))
    noise, fast = np.array([0.3, 0.5, 0.4]), np.ones((LENGTH - N_SLOW, N_CHANNELS))

    gains = compute_gains(slow, fast, noise, 4.0)

    variance = np.diag(np.tile(noise, N_SLOW) ** 2 / 4.0)
    plain = slow @ np.linalg.inv(slow + variance)
    coefficients = rng.normal(size=(6, len(slow)))
    scale = np.tile(gains.noise, N_SLOW)
    assert (gains.own is not None) == independent
    assert_allclose(gains.slow * scale[:, None] / scale, plain, atol=1e-12)
    mean = gains.posterior_mean(coefficients / scale) * scale
    assert_allclose(mean, coefficients @ plain.T, atol=1e-12)


def test_filters_of_windows_with_gaps_are_reused_if_given(rng):
    windows = Windows(30, LENGTH, 1.0)
    observed_mask = np.ones((30, N_CHANNELS), dtype=bool)
    observed_mask[12:20, 1] = False
    patterns = find_gap_patterns(observed_mask, windows, N_SLOW)
    parts = (np.full(N_CHANNELS, 0.3), 0.5, windows)
    before = build_filters(patterns, window_covariance(rng), *parts)

    after = build_filters(patterns, window_covariance(rng), *parts, reusable=before)

    reused = [one is other for one, other in zip(before, after, strict=True)]
    assert reused == [bool(pattern.channels.size) for pattern in patterns]
    assert 0 < sum(reused) < len(reused)


def test_only_channels_with_gaps_have_more_noise(rng):
    """A hand that is never observed must not smooth the observed arm."""
    windows = Windows(30, LENGTH, 1.0)
    observed_mask = np.ones((30, N_CHANNELS), dtype=bool)
    observed_mask[:, 1] = False
    patterns = find_gap_patterns(observed_mask, windows, N_SLOW)
    noise = np.full(N_CHANNELS, 0.3)

    (gapped,) = build_filters(patterns, window_covariance(rng, 1.0), noise, 0.5, windows)

    assert_allclose(gapped.gains.noise[[0, 2]], 0.3)
    assert gapped.gains.noise[1] > 0.4


def test_coefficients_and_frames_invert_each_other(rng):
    windows = Windows(30, 12, 2.0)
    frames = rng.normal(size=(4, 12, 3))

    assert_allclose(
        windows.frames_from_coefficients(windows.coefficients_from_frames(frames)),
        frames,
        atol=1e-12,
    )
    slowest = windows.coefficients_from_frames(frames)
    slowest[:, 5:] = 0.0
    basis = windows.dct_basis(5)
    expected = np.einsum("tk,nkc->ntc", basis, slowest[:, :5])
    assert_allclose(windows.frames_from_coefficients(slowest), expected, atol=1e-12)


def test_overlapping_windows_add_up_to_the_take(rng):
    windows = Windows(57, 20, 1.0)
    values = rng.normal(size=(57, 2))
    total = np.zeros_like(values)

    patterns = find_gap_patterns(np.isfinite(values), windows, N_SLOW)
    windows.add(total, windows.extract(values, windows.starts), windows.starts)

    assert_allclose(total / sum_window_weights(patterns, windows), values, atol=1e-12)


def test_every_frame_is_in_a_window_with_any_gaps(rng):
    observed_mask = rng.random((57, 2)) > 0.4
    observed_mask[:9] = False
    windows = Windows(57, 20, 1.0)

    assert (
        sum_window_weights(find_gap_patterns(observed_mask, windows, N_SLOW), windows) > 0.0
    ).all()


def test_finds_only_long_gaps():
    observed_mask = np.ones((20, 2), dtype=bool)
    observed_mask[3:5, 0] = False
    observed_mask[10:16, 0] = False
    observed_mask[17:, 1] = False

    gaps = find_long_gaps(observed_mask, 3)

    assert np.flatnonzero(gaps[:, 0]).tolist() == list(range(10, 16))
    assert np.flatnonzero(gaps[:, 1]).tolist() == [17, 18, 19]


def random_covariance(rng):
    factors = rng.normal(size=(N_SLOW * N_CHANNELS, 6))
    fading = np.repeat(0.6 ** np.arange(N_SLOW), N_CHANNELS)[:, None]
    return (factors * fading) @ (factors * fading).T + 0.01 * np.eye(len(factors))


def window_covariance(rng, fast=0.0):
    slow = random_covariance(rng).reshape(N_SLOW, N_CHANNELS, N_SLOW, N_CHANNELS)
    fast_variances, zeros = np.full((LENGTH - N_SLOW, N_CHANNELS), fast), np.zeros(N_CHANNELS)
    smooth = SmoothPrior(np.zeros((1, LENGTH, LENGTH)), zeros[None])
    prior = WindowPrior(zeros, slow, fast_variances, 0.0, 0.0, zeros, smooth)
    return covariance_from_prior(prior, LENGTH)


def frames_from(windows, coefficients):
    return windows.dct_basis(N_SLOW) @ coefficients.reshape(N_SLOW, N_CHANNELS)


def map_to_frames(windows):
    """Return the matrix from slow coefficients to frames, frames outermost."""
    return np.kron(windows.dct_basis(N_SLOW), np.eye(N_CHANNELS))


def dense_posterior(windows, slow, noise, noisy):
    basis = map_to_frames(windows)
    observed_samples = np.isfinite(noisy).ravel()
    prior = basis @ slow @ basis.T
    spread = prior[observed_samples][:, observed_samples] + np.diag(
        np.tile(noise**2, LENGTH)[observed_samples]
    )
    gain = np.linalg.solve(spread, prior[observed_samples]).T
    mean = gain @ noisy.ravel()[observed_samples]
    variance = np.diag(prior - gain @ prior[observed_samples])
    return mean.reshape(noisy.shape), variance.reshape(noisy.shape)


def frame_variance(windows, covariance):
    basis = map_to_frames(windows)
    return np.diag(basis @ covariance @ basis.T).reshape(LENGTH, N_CHANNELS)


def test_too_many_gap_patterns_are_filled_iteratively(rng, monkeypatch):
    observed_mask = rng.random((57, N_CHANNELS)) > 0.1
    observed_mask[20:40, 0] = False
    windows = Windows(57, 20, 1.0)
    assert len(find_gap_patterns(observed_mask, windows, N_SLOW)) > 1

    monkeypatch.setattr(
        "solvers.denoising.window_estimates.gap_patterns.MAX_MATRIX_ENTRIES", 50
    )

    (pattern,) = find_gap_patterns(observed_mask, windows, N_SLOW)
    assert not pattern.channels.size
