"""The correction is the minimum of its cost at any frame rate."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.signals.smooth_correction import (
    FADE_TIME_CONSTANTS,
    PULL_WEIGHT,
    smooth_correction,
)


def test_correction_equals_the_dense_least_squares_solution(rng):
    rate, blend, hold = 30.0, 0.4, 3.0
    speed = rng.normal(size=(19, 1))
    held = (rng.random((19, 1)) > 0.4) * rng.random((19, 1))
    goal, pulled = rng.normal(size=(20, 1)), rng.random((20, 1))

    found = smooth_correction(speed, held, rate, blend, hold=hold, goal=goal, pulled=pulled)

    bending = (blend / FADE_TIME_CONSTANTS * rate) ** 2 * np.diff(np.eye(20), n=2, axis=0)
    stepping = hold * np.sqrt(held) * np.diff(np.eye(20), axis=0) * rate
    pulling = np.sqrt(PULL_WEIGHT * pulled) * np.eye(20)
    system = np.concatenate([np.eye(20), bending, stepping, pulling])
    right = np.concatenate([
        np.zeros((20 + 18, 1)),
        hold * np.sqrt(held) * speed,
        np.sqrt(PULL_WEIGHT * pulled) * goal,
    ])
    assert_allclose(found, np.linalg.lstsq(system, right, rcond=None)[0], atol=1e-8)


@pytest.mark.parametrize("rate", [60.0, 240.0])
def test_free_correction_decays_as_documented(rate):
    """After a long constraint to 1: exp(-x) (cos x + sin x) with x = t / (tau sqrt 2)."""
    n_frames = int(4 * rate)
    pulled = (np.arange(n_frames) < 2 * rate)[:, None].astype(float)
    rest = np.zeros((n_frames - 1, 1))

    found = smooth_correction(
        rest, pulled[1:], rate, 0.5, hold=1000.0, goal=np.ones_like(pulled), pulled=pulled
    )[:, 0]

    time = np.arange(n_frames - int(2 * rate) + 1) / rate
    x = time * FADE_TIME_CONSTANTS / 0.5 / np.sqrt(2.0)
    expected = np.exp(-x) * (np.cos(x) + np.sin(x))
    # The last constrained frame ends half a frame late and deviates by a hundredth.
    assert_allclose(found[int(2 * rate) - 1 :], expected, atol=0.015 + 1.5 / rate)


def test_constrained_curve_keeps_its_speed():
    speed = np.full((119, 1), 0.2)
    held = np.ones((119, 1))

    found = smooth_correction(speed, held, 120.0, 0.3)[:, 0]

    assert_allclose(np.diff(found) * 120.0, 0.2, rtol=0.01)
    assert_allclose(found.mean(), 0.0, atol=1e-9)


def test_correction_is_zero_without_constraints(rng):
    assert not smooth_correction(rng.normal(size=(50, 3)), np.zeros(50), 30.0, 0.3).any()


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_short_clips_are_solved(n_frames):
    speed = np.ones((n_frames - 1, 3))

    found = smooth_correction(speed, np.ones(n_frames - 1), 30.0, 0.3)

    assert found.shape == (n_frames, 3)
    assert np.isfinite(found).all()
