"""Correlation times are estimated from a noisy take."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.fft import dct

from solvers.denoising.window_estimates.smoothness import (
    CORRELATION_TIMES_S,
    build_smooth_kernels,
    fit_smoothness,
)
from solvers.denoising.window_priors import Windows

WINDOW, RATE, N_FRAMES = 20, 30.0, 400


def test_kernels_are_covariances_of_the_coefficients():
    steps = np.subtract.outer(np.arange(WINDOW), np.arange(WINDOW)) / RATE
    for kernel, length in zip(
        build_smooth_kernels(WINDOW, RATE), CORRELATION_TIMES_S, strict=True
    ):
        frames = np.exp(-0.5 * (steps / length) ** 2)
        expected = dct(dct(frames, axis=0, norm="ortho"), axis=1, norm="ortho")
        assert_allclose(kernel, expected, atol=1e-12)


@pytest.mark.parametrize("index", [0, 2, 3])
@pytest.mark.parametrize("density", [1.0, 4.0])
def test_finds_correlation_time_and_variance_of_a_movement(rng, index, density):
    rate, n_frames = RATE * density, round(N_FRAMES * density)
    steps = np.subtract.outer(np.arange(n_frames), np.arange(n_frames)) / rate
    kernel = np.exp(-0.5 * (steps / CORRELATION_TIMES_S[index]) ** 2)
    values, vectors = np.linalg.eigh(kernel)
    factor = vectors * np.sqrt(np.maximum(values, 0.0))
    movement = 5.0 * factor @ rng.normal(size=(n_frames, 40))
    noisy = movement + rng.normal(size=movement.shape)
    windows = Windows(n_frames, round(WINDOW * density), density)

    weights = fit_smoothness(
        noisy, np.ones(40), build_smooth_kernels(WINDOW, RATE), windows
    ).mean(axis=1)  # fmt: skip

    assert_allclose(weights.sum(), 25.0, rtol=0.2)
    assert weights[max(index - 1, 0) : index + 2].sum() > 0.85 * weights.sum()


def test_noise_is_not_classified_as_movement(rng):
    noise = 3.0 * rng.normal(size=(N_FRAMES, 30))
    windows = Windows(N_FRAMES, WINDOW, 1.0)

    weights = fit_smoothness(
        noise, np.full(30, 3.0), build_smooth_kernels(WINDOW, RATE), windows
    )

    assert (weights >= 0.0).all()
    assert weights.sum(axis=0).mean() < 0.1 * 9.0


def test_few_frames_are_pooled_with_the_other_channels(rng):
    """One window has little information on one channel, so all channels count as well."""
    times = np.arange(WINDOW)[:, None] / RATE
    slow = 10.0 * np.sin(2 * np.pi * 0.5 * times + np.linspace(0, 6, 20))
    fast_channel = 5.0 * np.sin(2 * np.pi * 3.0 * times)
    windows, kernels = Windows(WINDOW, WINDOW, 1.0), build_smooth_kernels(WINDOW, RATE)

    fitted_alone = fit_smoothness(fast_channel, np.full(1, 3.0), kernels, windows)[:, 0]
    fitted_together = fit_smoothness(
        np.column_stack([slow, fast_channel]), np.full(21, 3.0), kernels, windows
    )[:, -1]  # fmt: skip

    assert (
        fitted_together[3:].sum() / fitted_together.sum()
        > fitted_alone[3:].sum() / fitted_alone.sum() + 0.05
    )


def test_constant_channels_have_finite_weights():
    windows, kernels = Windows(WINDOW, WINDOW, 1.0), build_smooth_kernels(WINDOW, RATE)

    weights = fit_smoothness(np.zeros((WINDOW, 2)), np.full(2, 0.01), kernels, windows)

    assert np.isfinite(weights).all()
    assert (weights >= 0.0).all()
