"""The covariance of all windows must be exact, though the windows are never built."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from numpy.lib.stride_tricks import sliding_window_view
from numpy.testing import assert_allclose, assert_array_equal

from solvers.denoising import learn_filter_bases
from solvers.denoising.channels import ExampleChannels
from solvers.denoising.window_priors.lag_covariance import (
    MAX_CLIP_ENDS,
    LagProducts,
    find_leading_eigenpairs,
)
from solvers.errors import InvalidMotionError
from solvers.progress import unwatched
from solvers.samples import GaitSettings, walking_gait


@pytest.mark.parametrize(("n_frames", "window"), [(40, 7), (9, 9), (10, 9), (30, 1)])
def test_equals_the_product_of_the_trajectory_matrix(rng, n_frames, window):
    values = rng.normal(size=(n_frames, 3)).cumsum(axis=0)

    products = LagProducts(3, window)
    products.add(values)

    trajectories = sliding_window_view(values, window, axis=0).transpose(0, 2, 1)
    matrix = trajectories.reshape(len(trajectories), -1)
    assert_allclose(products.total(), matrix.T @ matrix, rtol=1e-10, atol=1e-9)


def test_many_clips_are_summed_exactly(rng):
    clips = [rng.normal(size=(rng.integers(5, 12), 2)) for _ in range(2 * MAX_CLIP_ENDS + 3)]
    products = LagProducts(2, 5)
    for clip in clips:
        products.add(clip)

    windows = [sliding_window_view(clip, 5, axis=0).transpose(0, 2, 1) for clip in clips]
    matrix = np.concatenate(windows).reshape(-1, 10)
    assert_allclose(products.total(), matrix.T @ matrix, rtol=1e-10, atol=1e-9)


def test_many_frames_need_no_more_memory_than_few():
    few, many = (
        walking_gait(GaitSettings(duration=seconds, frame_rate=30.0)) for seconds in (60, 600)
    )

    assert peak_of_learning(many) < 1.1 * peak_of_learning(few)


def peak_of_learning(example) -> int:
    tracemalloc.start()
    learn_filter_bases([example])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


def test_long_example_is_learned_in_blocks():
    """Each minute has its own mean pose; only the patterns across minutes are missing."""
    walk = walking_gait(GaitSettings(duration=130.0, frame_rate=30.0))
    halves = [walk.slice(0, 1950), walk.slice(1950, 3900)]

    complete, parts = learn_filter_bases([walk]), learn_filter_bases(halves)

    assert len(complete.clip_means) == 2
    assert_allclose(complete.clip_means, parts.clip_means, atol=1e-6)
    assert_allclose(complete.slow, parts.slow, rtol=1e-6, atol=1e-9)


def test_patterns_contain_the_requested_energy(rng):
    factors = rng.normal(size=(300, 300)) * np.geomspace(1, 1e-4, 300)
    covariance = factors.T @ factors

    values, vectors = find_leading_eigenpairs(covariance, 0.99)

    everything = np.sort(np.linalg.eigvalsh(covariance))[::-1]
    n_needed = int(np.searchsorted(everything.cumsum(), 0.99 * everything.sum())) + 1
    assert_allclose(values, everything[:n_needed], rtol=1e-8)
    assert_allclose(covariance @ vectors, vectors * values, atol=1e-6 * values[0])


def test_eigenpairs_of_low_rank_are_the_same_in_every_call():
    """As of a short clip that repeats itself; Lanczos iteration differs in 10 of 40 such."""
    frames = np.arange(70)
    for rank in (1, 2, 4):
        waves = np.sin(np.outer(frames, np.arange(1, rank + 1)) / 7.0)
        for shift in range(10):
            amplitudes = (np.arange(30) + shift) % np.arange(2, rank + 2)[:, None] + 1.0
            products = LagProducts(30, 30)
            products.add(waves @ amplitudes)

            first, again = (find_leading_eigenpairs(products.total(), 0.999) for _ in range(2))

            for one, other in zip(first, again, strict=True):
                assert_array_equal(other, one)


def test_of_no_movement_there_are_eigenpairs_of_zero():
    values, vectors = find_leading_eigenpairs(np.zeros((600, 600)), 0.99)

    assert_array_equal(values, np.zeros(len(values)))
    assert np.isfinite(vectors).all()


def test_clip_without_a_joint_does_not_affect_it(swinging_leg):
    """The joint's mean, standard deviation and patterns equal those without the clip."""
    without_knee = swinging_leg.with_poses(swinging_leg.rotations.copy())
    without_knee.rotations[:, 1] = np.nan

    separate, both = (
        learn_filter_bases([swinging_leg]),
        learn_filter_bases([swinging_leg, without_knee]),
    )

    knee = 3 * separate.keys.tolist().index("joint knee") + np.arange(3)
    assert_allclose(both.mean[knee], separate.mean[knee], atol=1e-9)
    assert set(both.moving) == set(separate.moving)
    knee_channels = np.flatnonzero(np.isin(separate.moving, knee))
    knee_block = np.ix_(
        np.arange(len(separate.slow)),
        knee_channels,
        np.arange(len(separate.slow)),
        knee_channels,
    )
    assert_allclose(both.slow[knee_block], separate.slow[knee_block], rtol=1e-6, atol=1e-9)


def test_example_has_one_mean_pose_at_any_frame_rate(swinging_leg):
    """Takes at twice the rate of the patterns are split, but show one body."""
    bases = learn_filter_bases([swinging_leg, swinging_leg.slice(0, 90)])

    assert swinging_leg.frame_rate == 2 * float(bases.frame_rate)
    assert len(bases.clip_means) == 2


def test_example_at_a_rounded_frame_rate_keeps_all_its_frames(swinging_leg):
    """60 Hz written as 59.94: two interleaved takes at 30 Hz, as of exactly 60 Hz."""
    rounded = replace(swinging_leg, frame_rate=59.94)

    exact, almost = (
        ExampleChannels([each], 30.0, 20, [1.0]).read(unwatched)
        for each in (swinging_leg, rounded)
    )

    (_, takes), (_, slower) = *exact, *almost
    assert len(takes) == len(slower) == 2
    assert_allclose(slower[1][:60], takes[1][:60], atol=0.5)


def test_example_of_twice_the_weight_counts_as_two():
    first, second = (
        walking_gait(GaitSettings(cadence=cadence, duration=3.0, frame_rate=30.0))
        for cadence in (100, 120)
    )
    weighted = learn_filter_bases([first, second], weights=[3.0, 6.0])
    doubled = learn_filter_bases([first, second, second])
    plain = learn_filter_bases([first, second])
    for name in ("mean", "slow", "fast"):
        assert_allclose(getattr(weighted, name), getattr(doubled, name), rtol=1e-9, atol=1e-9)
    assert np.abs(weighted.slow - plain.slow).max() > 0.01 * np.abs(plain.slow).max()


@pytest.mark.parametrize("weights", [[1.0], [1.0, 0.0], [1.0, -2.0], [1.0, np.nan]])
def test_weights_must_fit_the_examples(weights):
    motion = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    with pytest.raises(InvalidMotionError, match="weights for 2 examples"):
        learn_filter_bases([motion, motion], weights=weights)
