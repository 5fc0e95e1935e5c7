"""The initial noise estimate determines the weight of the data, also of unusual channels."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import denoise
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
from solvers.signals.noise import DIFFERENCE_EFFICIENCY, estimate_noise, shrink_noise


def test_rough_noise_estimates_the_noise_without_the_motion(rng):
    time = np.arange(2000) / 60.0
    smooth = 30.0 * np.sin(2 * np.pi * time)[:, None]

    found = estimate_noise(smooth + rng.normal(scale=[0.5, 3.0], size=(2000, 2)))

    assert_allclose(found, [0.5, 3.0], rtol=0.1)


def test_efficiency_of_the_estimate_is_that_of_white_noise(rng):
    """The logarithm of a standard deviation from n samples has the variance 1 / (2 n)."""
    logs = np.log(estimate_noise(rng.normal(size=(200, 2000))))

    assert_allclose(0.5 / 200 / logs.var(), DIFFERENCE_EFFICIENCY, rtol=0.12)


def test_random_differences_of_channels_are_shrunk(rng):
    n_samples = np.full(60, 50)
    found = np.exp(np.log(2.0) + rng.normal(scale=np.sqrt(0.5 / 50), size=60))

    assert_allclose(shrink_noise(found, n_samples), 2.0, rtol=0.08)
    assert shrink_noise(found, n_samples).std() < 0.5 * found.std()


@pytest.mark.parametrize("own", [0.3, 20.0])
def test_channel_with_another_unit_keeps_its_own_noise(own, rng):
    """The root position in centimeters, among rotations in degrees."""
    found = np.append(np.exp(np.log(3.0) + rng.normal(scale=0.05, size=60)), own)

    assert_allclose(shrink_noise(found, np.full(61, 200))[-1], own, rtol=0.05)


@pytest.mark.parametrize("jitter", [0.0, 3.0])
def test_root_is_cleaned_at_any_noise_of_the_joints(jitter):
    """With the 3 degrees of the joints for its 4 mm, the root would lose its bob and sway."""
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=30.0))
    raw = corrupt(walk, CorruptionSettings(jitter=jitter, root_jitter=0.004))

    clean = denoise(raw).recording

    assert spread(clean, walk) < 0.7 * spread(raw, walk)


def spread(motion, truth):
    return (motion.root_positions - truth.root_positions).std()
