"""Sampling of curves equals SciPy's spline and closed forms."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import CubicSpline

from solvers.variation.curves.curve_sampling import sample_curves


@pytest.mark.parametrize("n_frames", [2, 3, 8, 100])
def test_sampling_interpolates_the_frames(n_frames, rng):
    curves = rng.normal(size=(n_frames, 2, 3))

    assert_allclose(sample_curves(curves, np.arange(n_frames)), curves, atol=1e-6)


def test_sampling_equals_the_cubic_spline_away_from_the_ends(rng):
    curves, times = rng.normal(size=(80, 4)), np.linspace(20.0, 60.0, 333)

    assert_allclose(
        sample_curves(curves, times), CubicSpline(np.arange(80), curves)(times), atol=1e-6
    )


def test_sampling_keeps_straight_lines_up_to_the_ends():
    line, times = np.outer(np.arange(9.0), [1.0, -2.0]), np.linspace(0.0, 8.0, 50)

    assert_allclose(sample_curves(line, times), np.outer(times, [1.0, -2.0]), atol=1e-5)


def test_sampling_repeats_a_single_frame():
    assert_allclose(sample_curves(np.ones((1, 3)), np.zeros(4)), np.ones((4, 3)))
