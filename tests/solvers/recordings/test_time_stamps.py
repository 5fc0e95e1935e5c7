"""A constant rate from uneven time stamps: exact where theory is, and gaps stay gaps."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.recordings.conventions.time_stamps import ConstantRate

FRAME = 1.0 / 30.0


def test_even_time_stamps_change_nothing(rng):
    values = rng.normal(size=(50, 4, 3))

    clock = ConstantRate("take", 8000.0 + np.arange(50) * FRAME)

    assert clock.frame_rate == 30.0
    assert_allclose(clock.positions(values), values, atol=1e-9)


def test_a_cubic_is_followed_exactly_through_uneven_stamps(rng):
    """Independent derivation: interpolation of third order reproduces cubics."""
    times = (np.arange(60) + rng.uniform(-0.2, 0.2, 60)) * FRAME
    times -= times[0]

    clock = ConstantRate("take", times)
    moments = np.arange(len(clock.positions(np.zeros((60, 1, 1))))) / clock.frame_rate

    inner = slice(2, -2)
    assert_allclose(
        clock.positions(cubic(times))[inner, 0, 0], cubic(moments)[inner, 0, 0], atol=1e-12
    )


def cubic(times):
    return (1.0 - 2.0 * times + 0.7 * times**2 + 3.0 * times**3)[:, None, None]


def test_late_frames_are_interpolated_and_missing_frames_are_gaps():
    times = np.array([0, 1, 2.4, 3, 4, 14, 15, 16]) * FRAME
    values = times[:, None, None] + np.zeros((1, 2, 3))

    clock = ConstantRate("take", times)
    found = clock.positions(values)

    expected = [True] * 5 + [False] * 9 + [True] * 3
    assert_array_equal(np.isfinite(found[:, 0, 0]), expected)
    assert_allclose(found[expected, 0, 0], np.flatnonzero(expected) * FRAME, atol=1e-12)


def test_pauses_do_not_change_the_rate():
    """Six pauses of 20.4 frames each, at 27 Hz, which is no common rate."""
    steps = np.where(np.arange(60) % 10 == 9, 20.4, 1.0) / 27.0

    clock = ConstantRate("take", np.cumsum(steps))

    assert clock.frame_rate == pytest.approx(27.0)


def test_no_observed_frame_is_dropped_next_to_a_gap(rng):
    """However the clock drifts: each frame has a moment within half a frame time of it."""
    steps = np.where(rng.uniform(size=300) < 0.2, 2.0, 1.0) + rng.normal(scale=0.05, size=300)
    times = np.cumsum(steps) * FRAME

    clock = ConstantRate("take", times)
    observed = np.flatnonzero(np.isfinite(clock.positions(np.zeros((300, 1, 3)))[:, 0, 0]))

    away = np.abs((times - times[0])[:, None] - observed / clock.frame_rate).min(axis=1)
    assert away.max() <= 0.5 * FRAME + 1e-9


def test_states_are_the_worse_of_both_neighbors_and_confidence_between_them():
    times = np.array([0.0, 1.0, 2.25, 3.0, 4.0, 9.0, 10.0]) * FRAME
    states = np.array([[2], [2], [1], [2], [2], [2], [0]], dtype=np.int8)
    confidence = np.array([[1.0], [1.0], [0.0], [1.0], [1.0], [1.0], [0.5]])

    clock = ConstantRate("take", times)

    assert clock.states(states)[:, 0].tolist() == [2, 2, 1, 2, 2, 0, 0, 0, 0, 2, 0]
    assert_allclose(clock.confidence(confidence)[:5, 0], [1, 1, 0.2, 1, 1], atol=1e-9)
    assert_allclose(clock.confidence(confidence)[5:9, 0], 0.0)


def test_what_is_not_observed_does_not_spread():
    values = np.arange(10.0)[:, None, None] * np.ones((1, 2, 3))
    values[4, 0] = np.nan

    found = ConstantRate("take", np.arange(10) * FRAME).positions(values)

    assert_array_equal(np.isnan(found), np.isnan(values))


@pytest.mark.parametrize(
    ("step", "rate"),
    [
        (0.0333, 30.0),
        (0.034, 30.0),
        (0.0667, 15.0),
        (0.04, 25.0),
        (0.0125, 80.0),
        (0.01389, 72.0),
        (0.00417, 240.0),
        (0.005, 200.0),
    ],
)
def test_the_rate_is_the_common_one_if_there_is_one_nearby(step, rate):
    assert ConstantRate("take", np.arange(100) * step).frame_rate == pytest.approx(rate)


def test_duplicate_frame_is_used_once():
    times = np.array([0, 1, 1, 2, 1.5, 3, 4]) * FRAME
    values = np.array([0, 1, 9, 2, 9, 3, 4.0])[:, None, None]

    found = ConstantRate("take", times).positions(values)

    assert_allclose(found[:, 0, 0], [0, 1, 2, 3, 4], atol=1e-9)


@pytest.mark.parametrize(
    ("times", "sentence"),
    [
        (np.arange(20)[::-1] * FRAME, "do not increase"),
        (np.full(20, 7.0), "do not increase"),
        (np.full(5, np.nan), "do not increase"),
        (np.full(5, 1e300), "do not increase"),
        (np.concatenate([np.arange(20) * FRAME, [1e9]]), r"21 frames span 1e\+09 s"),
        (np.arange(20) * 1e-7, "which is not possible"),
        (np.arange(20) * 1e7, "which is not possible"),
    ],
)
def test_invalid_time_stamps_are_refused(times, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        ConstantRate("take", times)


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_very_short_takes(n_frames):
    values = np.arange(float(n_frames))[:, None, None]

    assert_allclose(ConstantRate("take", np.arange(n_frames) * FRAME).positions(values), values)
