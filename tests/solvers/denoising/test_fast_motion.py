"""A gradual deviation is a motion; an abrupt one is a spike."""

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from solvers.denoising.posterior.fast_motion import find_fast_motion

GRADUAL = [0.0, 4.0, 10.0, 14.0, 9.0, 4.0, 0.0, 0.0]


def fast_motion(*columns, noise=0.05, rate=0.002, window=20):
    error = np.array(columns).T
    inlier = np.where(np.abs(error) > 1.0, 0.0, 1.0)
    return find_fast_motion(error, inlier, np.full(len(columns), noise), rate, window)


def test_channels_are_classified_independently():
    step_spike = [0.0, 0.0, 0.0, 14.0, 0.0, 0.0, 0.0, 0.0]
    burst = [0.0, 14.0, 14.0, 14.0, 14.0, 14.0, 0.0, 0.0]

    flagged = fast_motion(step_spike, GRADUAL, burst, [-each for each in GRADUAL])

    assert not flagged[:, [0, 2]].any()
    assert flagged[:, [1, 3]].any(axis=1).tolist() == [False] + 5 * [True] + 2 * [False]
    assert (flagged[:, 1] == flagged[:, 3]).all()


def test_deviation_with_one_steep_side_is_a_spike():
    steep = [0.0, 14.0, 10.0, 7.0, 4.0, 2.0, 0.0, 0.0]

    assert not fast_motion(steep, steep[::-1]).any()


def test_deviation_at_the_ends_or_next_to_gaps_is_a_spike():
    assert not fast_motion([4.0, 10.0, 4.0, 0.0, 0.0]).any()
    assert not fast_motion([0.0, np.nan, 14.0, 9.0, 4.0, 0.0]).any()


@pytest.mark.parametrize(("noise", "rate"), [(0.6, 0.002), (0.05, 0.05), (3.0, 0.4)])
def test_long_gradual_deviations_are_motion_despite_noise(noise, rate):
    short = [0.0, 0.0, 8.0, 9.0, 0.5, 0.0, 0.0, 0.0]
    rough = [0.0, 8.0, -9.0, 12.0, 5.0, -7.0, 0.0, 0.0]

    flagged = fast_motion(GRADUAL, short, rough, noise=noise, rate=rate)

    assert flagged[:, 0].tolist() == [False] + 5 * [True] + 2 * [False]
    assert not flagged[:, 1:].any()


def test_softened_spike_is_no_motion():
    soft = gaussian_filter1d(np.repeat([0.0, 30.0, 0.0], [20, 3, 20]), 0.6)

    assert not fast_motion(soft, noise=2.0, rate=0.1).any()


def test_spike_of_two_frames_is_no_motion_with_short_windows():
    spikes = np.tile([0.0, 0.0, 0.0, 0.0, 30.0, 31.0, 0.0, 0.0], 8)

    assert not fast_motion(spikes, noise=2.0, rate=0.3, window=3).any()


def test_deviation_through_zero_is_one_motion():
    swing = np.concatenate([
        np.zeros(9),
        [12, 24, 28, 16, 2, -13, -25, -28, -17, -3],
        np.zeros(9),
    ])

    flagged = fast_motion(swing, noise=2.0, rate=0.1)[:, 0]

    assert flagged[np.abs(swing) > 1.0].all()


def test_oscillation_is_motion():
    wave = 30.0 * np.sin(np.arange(100) * 2 * np.pi / 11.3)

    flagged = fast_motion(wave, noise=2.0, rate=0.4)[:, 0]

    deviating = np.abs(wave) > 1.0
    assert flagged[deviating][4:-6].all()
    assert not flagged[~deviating].any()


def test_deviation_as_long_as_a_window_is_motion():
    """The errors alternate in sign without a slope: only their duration decides."""
    lasting, brief = np.zeros(100), np.zeros(100)
    lasting[20:80] = 30.0 * (-1.0) ** np.arange(60)
    brief[20:28] = 30.0 * (-1.0) ** np.arange(8)

    flagged = fast_motion(lasting, brief, noise=2.0, rate=0.3)

    assert flagged[25:75, 0].all()
    assert not flagged[:, 1].any()
