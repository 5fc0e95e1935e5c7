"""Jitter that lasts several frames is found, and smoothed as such."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.fft import dct
from scipy.signal import butter, filtfilt, lfilter

from solvers.denoising import denoise, learn_filter_bases
from solvers.denoising.window_priors import WHITE, NoiseSpectrum
from solvers.motion import Motion
from solvers.rotations import angle_between, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait

RATE = 30.0
COLORED = "The jitter lasts several frames"


def shaped_noise(shape: tuple[int, ...], spectrum: NoiseSpectrum, seed: int = 5) -> np.ndarray:
    """Noise of deviation 1 with this power over the frequency of a long take."""
    noise = np.fft.rfft(np.random.default_rng(seed).normal(size=shape), axis=0)
    frequencies = np.maximum(np.arange(len(noise)), 1.0) / shape[0]
    gains = frequencies ** (-0.5 * spectrum.exponent)
    noise = np.fft.irfft(noise * gains.reshape(-1, *[1] * (len(shape) - 1)), n=shape[0], axis=0)
    return np.asarray(noise / noise.std())


def power_law_noise(shape: tuple[int, ...], exponent: float, seed: int = 5) -> np.ndarray:
    return shaped_noise(shape, NoiseSpectrum(exponent), seed)


def filtered_noise(shape: tuple[int, ...], cutoff: float, n_runs: int) -> np.ndarray:
    """White noise of deviation 1 after a filter of second order, cutoff in cycles per frame."""
    b, a = butter(2, 2.0 * cutoff)
    noise = np.random.default_rng(6).normal(size=shape)
    return np.asarray((lfilter if n_runs == 1 else filtfilt)(b, a, noise, axis=0))


def with_noise(motion: Motion, degrees: float, exponent: float) -> Motion:
    return with_vectors(motion, degrees * power_law_noise(vectors_shape(motion), exponent))


def vectors_shape(motion: Motion) -> tuple[int, int, int]:
    return *motion.rotations.shape[:2], 3


def with_vectors(motion: Motion, vectors: np.ndarray) -> Motion:
    vectors[:, [motion.skeleton.is_end_site(joint) for joint in range(motion.n_joints)]] = 0.0
    noise = quaternion_from_rotation_vector(np.radians(vectors))
    return motion.with_poses(multiply(motion.rotations, noise))


def mean_error(motion: Motion, truth: Motion) -> float:
    return float(np.degrees(angle_between(motion.rotations, truth.rotations)).mean())


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=6.0, frame_rate=RATE))


@pytest.mark.parametrize("exponent", [0.5, 1.0])
@pytest.mark.parametrize("length", [16, 40])
def test_spectrum_is_that_of_windows_of_a_long_take(length, exponent):
    noise = power_law_noise((64 * length, 300), exponent)
    windows = noise.reshape(64, length, 300)
    measured = np.square(dct(windows, axis=1, norm="ortho")).mean(axis=(0, 2))
    differences = np.sqrt(np.square(np.diff(noise, 3, axis=0)).mean() / 20.0)

    spectrum = NoiseSpectrum(exponent)
    relative = spectrum.variances(length) * spectrum.deviation_ratio(length) ** 2

    assert_allclose(measured[1:] / differences**2, relative[1:], rtol=0.3)
    assert_allclose(measured[4:] / differences**2, relative[4:], rtol=0.12)


@pytest.mark.parametrize("rate", [24.0, 30.0, 60.0, 120.0, 240.0])
@pytest.mark.parametrize("cutoff_hz", [6.0, 9.0])
@pytest.mark.parametrize("n_runs", [1, 2])
def test_deviation_of_filtered_noise_follows_from_its_differences(rate, cutoff_hz, n_runs):
    noise = filtered_noise((4000, 30), cutoff_hz / rate, n_runs)[100:-100]
    differences = np.sqrt(np.square(np.diff(noise, 3, axis=0)).mean() / 20.0)

    spectrum = NoiseSpectrum(cutoff=cutoff_hz / rate, n_runs=n_runs)

    ratio = spectrum.deviation_ratio(round(rate / 2))
    assert ratio == pytest.approx(noise.std() / differences, rel=0.05)


def test_white_noise_has_the_same_variance_at_all_frequencies():
    assert_allclose(WHITE.variances(15), 1.0)
    assert WHITE.deviation_ratio(15) == pytest.approx(1.0)
    assert NoiseSpectrum(1.5).variances(15).mean() == pytest.approx(1.0)


@pytest.mark.parametrize("n_runs", [1, 2])
def test_each_run_of_the_filter_leaves_half_of_the_power_at_its_cutoff(n_runs):
    variances = NoiseSpectrum(cutoff=0.25, n_runs=n_runs).variances(400)

    assert variances[200] / variances[1] == pytest.approx(0.5**n_runs, rel=1e-4)


@pytest.mark.parametrize(
    ("rate", "n_runs"), [(24.0, 2), (30.0, 1), (30.0, 2), (60.0, 2), (120.0, 1)]
)
def test_filtered_noise_is_found_and_more_of_it_removed(rate, n_runs, monkeypatch):
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=rate))
    degrees = 3.0 * np.sqrt(rate / 30.0)
    noise = degrees * filtered_noise(vectors_shape(walk), 8.0 / rate, n_runs)
    noisy = with_vectors(walk, noise)

    cleaned = denoise(noisy)
    set_white(monkeypatch)
    as_white = denoise(noisy)

    assert COLORED in cleaned.prior_used
    assert isinstance(cleaned.recording, Motion)
    assert isinstance(as_white.recording, Motion)
    error = mean_error(cleaned.recording, walk)
    assert error < 0.85 * mean_error(as_white.recording, walk)


def set_white(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "solvers.denoising.default_method.find_noise_spectrum", lambda *_: WHITE
    )


@pytest.mark.parametrize("rate", [30.0, 60.0])
def test_fast_movement_that_repeats_itself_is_no_noise(rate):
    walk = walking_gait(GaitSettings(duration=12.0, frame_rate=rate / 3.0))
    fast = Motion(walk.skeleton, walk.rotations, walk.root_positions, rate)

    cleaned = denoise(fast)

    assert COLORED not in cleaned.prior_used
    assert isinstance(cleaned.recording, Motion)
    assert mean_error(cleaned.recording, fast) < 0.05


@pytest.mark.parametrize(("rate", "degrees", "noise"), [(30.0, 2.0, 0.0), (60.0, 15.0, 1.0)])
def test_a_shiver_is_no_noise(rate, degrees, noise):
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=rate))
    rng, seconds = np.random.default_rng(8), np.arange(walk.n_frames) / rate
    phases = rng.uniform(0.0, 2.0 * np.pi, vectors_shape(walk)[1:])
    shiver = degrees * np.sin(10.0 * np.pi * seconds[:, None, None] + phases)
    truth = with_vectors(walk, shiver)
    noisy = with_vectors(truth, noise * rng.normal(size=shiver.shape))

    cleaned = denoise(noisy).recording

    assert isinstance(cleaned, Motion)
    assert mean_error(cleaned, truth) < mean_error(noisy, truth) + 0.05


@pytest.mark.parametrize("degrees", [2.0, 4.0])
def test_colored_noise_is_found_and_more_of_it_removed(walk, degrees, monkeypatch):
    noisy = with_noise(walk, degrees, 1.0)

    cleaned = denoise(noisy)
    set_white(monkeypatch)
    as_white = denoise(noisy)

    assert COLORED in cleaned.prior_used
    assert COLORED not in as_white.prior_used
    assert isinstance(cleaned.recording, Motion)
    assert isinstance(as_white.recording, Motion)
    error = mean_error(cleaned.recording, walk)
    assert error < 0.8 * mean_error(as_white.recording, walk)


def test_examples_help_with_colored_noise(walk):
    others = [
        walking_gait(GaitSettings(duration=6.0, frame_rate=RATE, speed=speed))
        for speed in (1.1, 1.25, 1.5)
    ]
    noisy = with_noise(walk, 3.0, 1.0)

    alone, with_examples = denoise(noisy), denoise(noisy, learn_filter_bases(others))

    assert isinstance(alone.recording, Motion)
    assert isinstance(with_examples.recording, Motion)
    error = mean_error(with_examples.recording, walk)
    assert error < 0.9 * mean_error(alone.recording, walk)


@pytest.mark.parametrize(("exponent", "is_colored"), [(0.0, False), (1.0, True)])
def test_path_has_a_spectrum_of_its_own(walk, exponent, is_colored, monkeypatch):
    noise = 0.04 * power_law_noise((walk.n_frames, 3), exponent, seed=7)
    noisy = with_noise(walk, 3.0, 1.0).with_poses(root_positions=walk.root_positions + noise)

    cleaned = denoise(noisy)
    set_white(monkeypatch)
    as_white = denoise(noisy)

    assert COLORED in cleaned.prior_used
    assert isinstance(cleaned.recording, Motion)
    assert isinstance(as_white.recording, Motion)
    difference = cleaned.recording.root_positions - as_white.recording.root_positions
    assert (np.abs(difference).max() > 1e-3) == is_colored


def test_gaps_and_outliers_keep_what_the_first_estimate_knows_of_them(walk):
    noisy = with_noise(walk, 3.0, 1.0)
    joint = noisy.skeleton.names.index("LeftForeArm")
    rotations = noisy.rotations.copy()
    rotations[60:90, joint] = np.nan
    spike = quaternion_from_rotation_vector(np.radians([80.0, 0.0, 0.0]))
    rotations[120, joint] = multiply(rotations[120, joint], spike)

    cleaned = denoise(noisy.with_poses(rotations))

    assert COLORED in cleaned.prior_used
    assert cleaned.outliers[120, joint]
    assert cleaned.confidence[70:80, joint].max() < cleaned.confidence[30:50, joint].min()
    assert np.isfinite(cleaned.recording.rotations).all()


@pytest.mark.parametrize(
    ("degrees", "exponent"), [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (0.2, 1.0)]
)
def test_clean_takes_and_white_or_small_noise_are_white(walk, degrees, exponent):
    assert COLORED not in denoise(with_noise(walk, degrees, exponent)).prior_used


@pytest.mark.parametrize("rate", [12.0, 20.0])
def test_noise_of_slow_recordings_is_white(rate):
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=rate))

    assert COLORED not in denoise(with_noise(walk, 3.0, 1.0)).prior_used


@pytest.mark.parametrize("n_frames", [1, 2, 15, 16, 19, 20, 21])
def test_takes_of_about_a_window_are_cleaned(walk, n_frames):
    noisy = with_noise(walk, 3.0, 1.0).slice(0, n_frames)

    cleaned = denoise(noisy).recording

    assert isinstance(cleaned, Motion)
    assert np.isfinite(cleaned.rotations).all()
