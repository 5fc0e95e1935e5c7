"""Noise that is correlated over time is found, and smoothed as such."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.fft import dct

from solvers.denoising import denoise
from solvers.denoising.motion_model.noise_spectrum import deviation_ratio, noise_spectrum
from solvers.motion import Motion
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

RATE = 30.0
CORRELATED = "The jitter lasts several frames"


def autoregressive(shape: tuple[int, ...], correlation: float, seed: int = 5) -> np.ndarray:
    """Stationary noise of deviation 1; each frame has this correlation with the one before."""
    white = np.random.default_rng(seed).normal(size=shape)
    noise = white.copy()
    for frame in range(1, shape[0]):
        innovation = np.sqrt(1.0 - correlation**2) * white[frame]
        noise[frame] = correlation * noise[frame - 1] + innovation
    return noise


def with_noise(motion: Motion, degrees: float, correlation: float) -> Motion:
    vectors = degrees * autoregressive((*motion.rotations.shape[:2], 3), correlation)
    vectors[:, [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]] = 0.0
    noise = quaternion_from_rotation_vector(np.radians(vectors))
    return motion.with_poses(multiply(motion.rotations, noise))


def mean_error(motion: Motion, truth: Motion) -> float:
    return float(np.degrees(angle_between(motion.rotations, truth.rotations)).mean())


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=6.0, frame_rate=RATE))


@pytest.mark.parametrize("correlation_s", [0.01, 0.04])
@pytest.mark.parametrize("rate", [30.0, 120.0])
def test_spectrum_is_that_of_autoregressive_noise(rate, correlation_s):
    length, n_windows = round(rate), 4000
    noise = autoregressive((length, n_windows), np.exp(-1.0 / (rate * correlation_s)))
    measured = np.square(dct(noise, axis=0, norm="ortho")).mean(axis=1)
    differences = np.sqrt(np.square(np.diff(noise, 3, axis=0)).mean() / 20.0)

    spectrum = noise_spectrum(12, length, rate, correlation_s)

    assert_allclose(measured[1:12] / differences**2, spectrum[1:], rtol=0.15)
    assert deviation_ratio(rate, correlation_s) == pytest.approx(1.0 / differences, rel=0.03)


def test_white_noise_has_the_same_variance_at_all_frequencies():
    assert_allclose(noise_spectrum(12, 15, RATE, 0.0), 1.0)
    assert deviation_ratio(RATE, 0.0) == pytest.approx(1.0)


@pytest.mark.parametrize("degrees", [2.0, 4.0])
def test_correlated_noise_is_found_and_more_of_it_removed(walk, degrees, monkeypatch):
    """The noise of one frame has a correlation of 0.43 with that of the next."""
    noisy = with_noise(walk, degrees, 0.43)

    cleaned = denoise(noisy)
    monkeypatch.setattr("solvers.denoising.default_method.noise_correlation", lambda *_: 0.0)
    as_white = denoise(noisy)

    assert CORRELATED in cleaned.prior_used
    assert CORRELATED not in as_white.prior_used
    assert isinstance(cleaned.recording, Motion)
    assert isinstance(as_white.recording, Motion)
    error = mean_error(cleaned.recording, walk)
    assert error < 0.9 * mean_error(as_white.recording, walk)


@pytest.mark.parametrize(
    ("degrees", "correlation"), [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (0.2, 0.6)]
)
def test_clean_takes_and_white_or_small_noise_are_not_correlated(walk, degrees, correlation):
    assert CORRELATED not in denoise(with_noise(walk, degrees, correlation)).prior_used


@pytest.mark.parametrize("rate", [12.0, 24.0])
def test_noise_of_slow_recordings_is_white(rate):
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=rate))

    assert CORRELATED not in denoise(with_noise(walk, 3.0, 0.43)).prior_used
