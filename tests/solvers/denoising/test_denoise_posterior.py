"""Where theory is exact, the default method must be exact."""

import numpy as np
from numpy.testing import assert_allclose

from solvers.denoising.posterior.covariance import Covariance
from solvers.denoising.posterior.filters import (
    Filter,
    filters_of,
    gains_of,
    variance_of,
    weight_of,
)
from solvers.denoising.posterior.gap_patterns import GapSolution, gap_patterns, long_gaps
from solvers.denoising.posterior.windows import Windows

LENGTH, N_SLOW, N_CHANNELS = 8, 5, 3


def test_a_window_with_gaps_is_the_conditional_gaussian(rng):
    """One dense system over the observed samples says the same as the small one per pattern."""
    windows = Windows(LENGTH, LENGTH, 1.0)
    slow = some_covariance(rng)
    noise = np.array([0.3, 0.5, 0.4])
    truth = frames_from(windows, rng.multivariate_normal(np.zeros(len(slow)), slow))
    noisy = truth + rng.normal(size=truth.shape) * noise
    noisy[2:6, 1] = np.nan
    noisy[:4, 2] = np.nan
    (pattern,) = gap_patterns(np.isfinite(noisy), windows, N_SLOW)
    gains = gains_of(slow, np.zeros((LENGTH - N_SLOW, N_CHANNELS)), noise, 1.0)
    solution = GapSolution.of(pattern, gains.slow)
    observed = windows.waves_of(pattern.observed(np.nan_to_num(noisy)[None]))[:, :N_SLOW]

    found = solution.mean((observed / noise).reshape(1, -1), pattern.places)[0]
    estimate = frames_from(windows, found * np.tile(noise, N_SLOW))

    mean, variance = dense_posterior(windows, slow, noise, noisy)
    assert_allclose(estimate, mean, atol=1e-9)
    filters = [Filter(pattern, gains, solution)]
    found_variance, leverage = variance_of(filters, windows, noisy)
    assert_allclose(found_variance[:, 1:], variance[:, 1:], atol=1e-9)
    assert_allclose(leverage[:, 1:], variance[:, 1:] / noise[1:] ** 2, atol=1e-9)
    covariance = np.zeros_like(slow)
    filters[0].add_covariance(covariance)
    assert_allclose(frame_variance(windows, covariance)[:, 1:], variance[:, 1:], atol=1e-9)


def test_gapped_windows_keep_their_filter_while_it_is_nearly_right(rng):
    windows = Windows(30, LENGTH, 1.0)
    known = np.ones((30, N_CHANNELS), dtype=bool)
    known[12:20, 1] = False
    patterns = gap_patterns(known, windows, N_SLOW)
    parts = (np.full(N_CHANNELS, 0.3), 0.5, windows)
    before = filters_of(patterns, whole_covariance(rng), *parts)

    after = filters_of(patterns, whole_covariance(rng), *parts, stale=before)

    kept = [one is other for one, other in zip(before, after, strict=True)]
    assert kept == [bool(pattern.channels.size) for pattern in patterns]
    assert 0 < sum(kept) < len(kept)


def test_only_channels_with_gaps_are_blurred(rng):
    """A hand that is never seen must not smooth the arm that is."""
    windows = Windows(30, LENGTH, 1.0)
    known = np.ones((30, N_CHANNELS), dtype=bool)
    known[:, 1] = False
    patterns = gap_patterns(known, windows, N_SLOW)
    noise = np.full(N_CHANNELS, 0.3)

    (gapped,) = filters_of(patterns, whole_covariance(rng, 1.0), noise, 0.5, windows)

    assert_allclose(gapped.gains.noise[[0, 2]], 0.3)
    assert gapped.gains.noise[1] > 0.4


def test_waves_and_frames_undo_each_other(rng):
    windows = Windows(30, 12, 2.0)
    frames = rng.normal(size=(4, 12, 3))

    assert_allclose(windows.frames_of(windows.waves_of(frames)), frames, atol=1e-12)
    slowest = windows.waves_of(frames)
    slowest[:, 5:] = 0.0
    shapes = windows.wave_shapes(5)
    expected = np.einsum("tk,nkc->ntc", shapes, slowest[:, :5])
    assert_allclose(windows.frames_of(slowest), expected, atol=1e-12)


def test_overlapping_windows_add_up_to_the_take(rng):
    windows = Windows(57, 20, 1.0)
    values = rng.normal(size=(57, 2))
    total = np.zeros_like(values)

    patterns = gap_patterns(np.isfinite(values), windows, N_SLOW)
    windows.add(total, windows.cut(values, windows.starts), windows.starts)

    assert_allclose(total / weight_of(patterns, windows), values, atol=1e-12)


def test_all_frames_are_in_a_window_whatever_is_missing(rng):
    known = rng.random((57, 2)) > 0.4
    known[:9] = False
    windows = Windows(57, 20, 1.0)

    assert (weight_of(gap_patterns(known, windows, N_SLOW), windows) > 0.0).all()


def test_only_long_gaps_are_long():
    known = np.ones((20, 2), dtype=bool)
    known[3:5, 0] = False
    known[10:16, 0] = False
    known[17:, 1] = False

    gaps = long_gaps(known, 3)

    assert np.flatnonzero(gaps[:, 0]).tolist() == list(range(10, 16))
    assert np.flatnonzero(gaps[:, 1]).tolist() == [17, 18, 19]


def some_covariance(rng):
    factors = rng.normal(size=(N_SLOW * N_CHANNELS, 6))
    fading = np.repeat(0.6 ** np.arange(N_SLOW), N_CHANNELS)[:, None]
    return (factors * fading) @ (factors * fading).T + 0.01 * np.eye(len(factors))


def whole_covariance(rng, fast=0.0):
    slow = some_covariance(rng)
    return Covariance(slow, slow, np.full((LENGTH - N_SLOW, N_CHANNELS), fast))


def frames_from(windows, waves):
    return windows.wave_shapes(N_SLOW) @ waves.reshape(N_SLOW, N_CHANNELS)


def map_to_frames(windows):
    """The matrix from slow waves (waves outermost) to frames (frames outermost)."""
    return np.kron(windows.wave_shapes(N_SLOW), np.eye(N_CHANNELS))


def dense_posterior(windows, slow, noise, noisy):
    shapes = map_to_frames(windows)
    seen = np.isfinite(noisy).ravel()
    prior = shapes @ slow @ shapes.T
    spread = prior[seen][:, seen] + np.diag(np.tile(noise**2, LENGTH)[seen])
    gain = np.linalg.solve(spread, prior[seen]).T
    mean = gain @ noisy.ravel()[seen]
    variance = np.diag(prior - gain @ prior[seen])
    return mean.reshape(noisy.shape), variance.reshape(noisy.shape)


def frame_variance(windows, covariance):
    shapes = map_to_frames(windows)
    return np.diag(shapes @ covariance @ shapes.T).reshape(LENGTH, N_CHANNELS)


def test_gaps_of_endless_patterns_do_not_fill_the_memory(rng, monkeypatch):
    known = rng.random((57, N_CHANNELS)) > 0.1
    known[20:40, 0] = False
    windows = Windows(57, 20, 1.0)
    assert len(gap_patterns(known, windows, N_SLOW)) > 1

    monkeypatch.setattr("solvers.denoising.posterior.gap_patterns.MOST_NUMBERS", 50)

    (pattern,) = gap_patterns(known, windows, N_SLOW)
    assert not pattern.channels.size
