"""The local noise of a joint is that of its jitter, not of its movement."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising.quality.joint_signals import estimate_local_noise


@pytest.mark.parametrize("n_components", [3, 4])
def test_local_noise_is_the_standard_deviation_of_one_component(rng, n_components):
    """Quaternions have four components, which vary in three directions."""
    noise = np.pad(0.02 * rng.normal(size=(4000, 3)), [(0, 0), (0, n_components - 3)])
    noise[500:520] = np.nan

    found = estimate_local_noise(noise, 400)

    assert np.median(found) == pytest.approx(0.02, rel=0.05)


def test_local_noise_is_high_where_the_noise_is(rng):
    """White noise of given deviation in the second half of a 2 Hz swing sampled at 30 Hz."""
    time = np.arange(600) / 30.0
    trajectory = np.sin(2 * np.pi * 2.0 * time)[:, None] * [1.0, 0.0, 0.0]
    trajectory[300:] += rng.normal(scale=0.05, size=(300, 3))

    shake = estimate_local_noise(trajectory, 30)

    assert shake[:280].max() == 0.0
    assert_allclose(np.median(shake[320:]), 0.05, rtol=0.2)
