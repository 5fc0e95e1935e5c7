"""The published filter must minimize the cost in its paper."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import minimize

from solvers.denoising import DenoiseMethod, DenoiseSettings, denoise, learn_filter_bases
from solvers.denoising.published import (
    PATTERN_WEIGHT,
    WELSCH_SCALE_DEG,
    alternate,
    published_cost,
)

WINDOW = 6


@pytest.fixture
def patterns(rng):
    """Four orthonormal patterns of windows of two channels."""
    return np.linalg.qr(rng.normal(size=(WINDOW * 2, 4)))[0].T.reshape(4, WINDOW, 2)


@pytest.fixture
def noisy(rng):
    values = rng.normal(size=(14, 2)).cumsum(axis=0)
    values[5, 0] += 25.0
    values[8:10, 1] = np.nan
    return values


def test_cost_equals_that_of_the_best_pattern_weights(patterns, noisy, rng):
    """Eq. 2.16 of [LOU12] by explicit least squares, one window at a time."""
    motion = rng.normal(size=noisy.shape)
    observed_mask = np.isfinite(noisy)
    residual = (motion - noisy)[observed_mask]
    robust = (
        WELSCH_SCALE_DEG**2 / 2 * (1 - np.exp(-((residual / WELSCH_SCALE_DEG) ** 2)))
    ).sum()
    E = patterns.reshape(4, -1).T
    distance = 0.0
    for start in range(len(motion) - WINDOW + 1):
        window = motion[start : start + WINDOW].ravel()
        weights = np.linalg.lstsq(E, window, rcond=None)[0]
        distance += ((window - E @ weights) ** 2).sum()

    cost = published_cost(motion, np.nan_to_num(noisy), observed_mask, patterns)

    assert_allclose(cost, robust + PATTERN_WEIGHT * distance, rtol=1e-12)


def test_alternation_reaches_the_minimum_of_direct_descent(patterns, noisy, monkeypatch):
    monkeypatch.setattr("solvers.denoising.published.MAX_ITERATIONS", 3000)
    monkeypatch.setattr("solvers.denoising.published.MAX_RELATIVE_CHANGE", 1e-12)
    observed_mask, observed = np.isfinite(noisy), np.nan_to_num(noisy)

    motion, weight, _, converged = alternate(noisy, patterns)

    def cost(flat):
        return published_cost(flat.reshape(noisy.shape), observed, observed_mask, patterns)

    better = minimize(cost, motion.ravel(), options={"gtol": 1e-9})
    assert converged
    assert cost(motion.ravel()) - better.fun < 1e-5 * better.fun
    assert weight[5, 0] < 1e-6


def test_every_round_lowers_the_cost(patterns, noisy, monkeypatch):
    observed_mask, observed = np.isfinite(noisy), np.nan_to_num(noisy)
    costs = []
    for rounds in range(1, 8):
        monkeypatch.setattr("solvers.denoising.published.MAX_ITERATIONS", rounds)
        motion, _, _, _ = alternate(noisy, patterns)
        costs.append(published_cost(motion, observed, observed_mask, patterns))

    assert (np.diff(costs) <= 1e-9).all()


def test_reports_why_it_does_not_use_the_examples(swinging_leg, leg):
    settings = DenoiseSettings(method=DenoiseMethod.PUBLISHED)
    names = dict(zip(leg.names, ("hip", "knee", "foot", "end"), strict=True))
    other = replace(leg, names=tuple(names.values()))
    foreign = learn_filter_bases([replace(swinging_leg, skeleton=other)])
    bases = learn_filter_bases([swinging_leg])

    messages = [
        denoise(swinging_leg, None, settings=settings).prior_used,
        denoise(swinging_leg, foreign, settings=settings).prior_used,
        denoise(swinging_leg.slice(0, 30), bases, settings=settings).prior_used,
        denoise(swinging_leg, bases, settings=settings).prior_used,
    ]

    assert messages == [
        "The take's own patterns: no examples were given.",
        "The take's own patterns: the examples lack one joint of the take; all are required.",
        "The take's own patterns: the take is shorter than the example patterns.",
        "Patterns of 1 example clip.",
    ]
