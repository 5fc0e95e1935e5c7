"""The covariance of all windows must be exact, though the windows are never built."""

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view
from numpy.testing import assert_allclose

from solvers.denoising import learn_filter_bases
from solvers.denoising.lag_covariance import lag_products, strongest


@pytest.mark.parametrize(("n_frames", "window"), [(40, 7), (9, 9), (10, 9), (30, 1)])
def test_equals_the_product_of_the_trajectory_matrix(rng, n_frames, window):
    values = rng.normal(size=(n_frames, 3)).cumsum(axis=0)

    products = lag_products([values], window)

    trajectories = sliding_window_view(values, window, axis=0).transpose(0, 2, 1)
    matrix = trajectories.reshape(len(trajectories), -1)
    assert_allclose(products, matrix.T @ matrix, rtol=1e-10, atol=1e-9)


def test_patterns_hold_the_share_that_is_asked_for(rng):
    factors = rng.normal(size=(300, 300)) * np.geomspace(1, 1e-4, 300)
    covariance = factors.T @ factors

    values, vectors = strongest(covariance, 0.99)

    everything = np.sort(np.linalg.eigvalsh(covariance))[::-1]
    n_needed = int(np.searchsorted(everything.cumsum(), 0.99 * everything.sum())) + 1
    assert_allclose(values, everything[:n_needed], rtol=1e-8)
    assert_allclose(covariance @ vectors, vectors * values, atol=1e-6 * values[0])


def test_a_clip_that_lacks_a_joint_tells_nothing_of_it(swinging_leg):
    """As if it had not been given, for the joint's mean, spread and patterns."""
    lost = swinging_leg.with_poses(swinging_leg.rotations.copy())
    lost.rotations[:, 1] = np.nan

    alone, both = learn_filter_bases([swinging_leg]), learn_filter_bases([swinging_leg, lost])

    knee = 3 * alone.keys.tolist().index("joint knee") + np.arange(3)
    assert_allclose(both.mean[knee], alone.mean[knee], atol=1e-9)
    assert set(both.moving) == set(alone.moving)
    places = np.flatnonzero(np.isin(alone.moving, knee))
    own = np.ix_(np.arange(len(alone.slow)), places, np.arange(len(alone.slow)), places)
    assert_allclose(both.slow[own], alone.slow[own], rtol=1e-6, atol=1e-9)


def test_an_example_has_one_mean_pose_at_any_frame_rate(swinging_leg):
    """Takes at twice the rate of the patterns are split; the body is one."""
    bases = learn_filter_bases([swinging_leg, swinging_leg.slice(0, 90)])

    assert swinging_leg.frame_rate == 2 * float(bases.frame_rate)
    assert len(bases.clip_means) == 2
