"""Resampled recordings show the same motion over the same time."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, Tracks, forward_kinematics, resample
from solvers.rotations.representations import (
    angle_between,
    quaternion_from_rotation_vector,
    unroll,
)


def sine_tracks(rate: float, seconds: float, highest: float = 4.0) -> Tracks:
    """Three points that move with frequencies up to `highest` hertz."""
    time = np.arange(round(seconds * rate) + 1) / rate
    angles = 2 * np.pi * np.linspace(0.3, highest, 9).reshape(3, 3) * time[:, None, None]
    return Tracks(("a", "b", "c"), np.sin(angles + np.arange(3)), rate)


def test_interpolated_frames_are_accurate():
    slow, fast = sine_tracks(30.0, 4.0, 2.0), sine_tracks(120.0, 4.0, 2.0)

    result = resample(slow, 120.0)

    assert result.frame_rate == 120.0
    assert result.n_frames == fast.n_frames
    assert np.abs(result.positions - fast.positions)[8:-8].max() < 1.5e-3


def test_interpolation_of_a_cubic_is_exact():
    """Four points determine a cubic, even at the ends."""
    time = np.arange(8) / 10.0
    cubic = np.stack([time**3 - time, 1 - time**2, 2 * time], axis=-1)[:, None]

    result = resample(Tracks(("a",), cubic, 10.0), 35.0)

    dense = np.arange(result.n_frames) / 35.0
    assert_allclose(
        result.positions[:, 0],
        np.stack([dense**3 - dense, 1 - dense**2, 2 * dense], axis=-1),
        atol=1e-12,
    )


@pytest.mark.parametrize("rate", [45.0, 60.0, 100.0, 240.0])
def test_resampling_back_restores_low_frequencies(rate):
    original = sine_tracks(60.0, 3.0)

    back = resample(resample(original, rate), 60.0)

    n = back.n_frames
    assert n >= original.n_frames - 1
    assert np.abs(back.positions - original.positions[:n])[6:-6].max() < 0.02


def test_doubling_and_halving_the_rate_restores_the_frames():
    original = sine_tracks(60.0, 3.0)

    back = resample(resample(original, 120.0), 60.0)

    assert np.abs(back.positions - original.positions)[10:-10].max() < 2e-3


def test_rotations_are_interpolated_along_the_shortest_path(swinging_leg, rng):
    signs = rng.choice([-1.0, 1.0], size=(swinging_leg.n_frames, swinging_leg.n_joints, 1))
    flipped = swinging_leg.with_poses(signs * swinging_leg.rotations)

    result = resample(flipped, 150.0)

    time = np.arange(result.n_frames) / 150.0
    hip = quaternion_from_rotation_vector(
        0.5 * np.sin(2 * np.pi * time)[:, None] * np.array([1.0, 0, 0])
    )
    assert angle_between(result.rotations[:, 0], hip).max() < 1e-4
    assert_allclose(unroll(result.rotations), result.rotations)


def test_downsampling_does_not_alias():
    time = np.arange(600) / 120.0
    hum = np.sin(2 * np.pi * 27.0 * time)  # would look like 3 Hz at 30 Hz
    positions = np.stack([hum, np.sin(2 * np.pi * time), 0 * time], axis=-1)[:, None]

    result = resample(Tracks(("a",), positions, 120.0), 30.0).positions[:, 0]

    inner = slice(20, -20)
    assert np.abs(result[inner, 0]).max() < 2e-3
    slow = np.sin(2 * np.pi * np.arange(len(result)) / 30.0)
    assert np.abs(result[inner, 1] - slow[inner]).max() < 2e-3


def test_constant_drift_is_exact_at_the_ends():
    drift = np.arange(121)[:, None, None] / 120.0 * np.array([1.0, -2.0, 0.5])

    slower = resample(Tracks(("a",), drift, 120.0), 30.0).positions

    assert_allclose(slower, drift[::4], atol=1e-12)


def test_resampling_is_symmetric_in_time(rng):
    noise = Tracks(("a",), rng.normal(size=(41, 1, 3)), 60.0)
    backwards = noise.with_positions(noise.positions[::-1])

    for rate in (30.0, 120.0):
        expected = resample(noise, rate).positions[::-1]
        assert_allclose(resample(backwards, rate).positions, expected, atol=1e-12)


@pytest.mark.parametrize(("n_frames", "old", "new", "expected"), [
    (61, 60.0, 30.0, 31), (60, 60.0, 30.0, 30), (11, 10.0, 30.0, 31), (5, 30.0, 29.97, 4),
    (101, 29.97, 59.94, 201), (1, 30.0, 120.0, 1), (2, 120.0, 30.0, 1),
])  # fmt: skip
def test_last_frame_is_not_after_that_of_the_recording(n_frames, old, new, expected):
    still = Tracks(("a",), np.ones((n_frames, 1, 3)), old)

    result = resample(still, new)

    assert result.n_frames == expected
    assert_allclose(result.positions, 1.0)


def test_gaps_keep_their_times():
    positions = sine_tracks(60.0, 2.0).positions
    positions[30:60, 1] = np.nan

    result = resample(Tracks(("a", "b", "c"), positions, 60.0), 120.0)

    assert np.isnan(result.positions[59:120, 1]).all()
    assert np.isfinite(result.positions[:59, 1]).all()
    assert np.isfinite(result.positions[120:, 1]).all()
    assert np.isfinite(result.positions[:, [0, 2]]).all()


def test_point_never_observed_stays_missing():
    positions = sine_tracks(60.0, 1.0).positions
    positions[:, 0] = np.nan

    assert np.isnan(
        resample(Tracks(("a", "b", "c"), positions, 60.0), 24.0).positions[:, 0]
    ).all()


def test_the_same_rate_changes_nothing(swinging_leg):
    result = resample(swinging_leg, swinging_leg.frame_rate)

    assert_allclose(result.rotations, swinging_leg.rotations, atol=1e-15)
    assert_allclose(result.root_positions, swinging_leg.root_positions)


def test_feet_keep_their_paths(swinging_leg):
    result = forward_kinematics(resample(swinging_leg, 240.0)).positions[::4]

    expected = forward_kinematics(swinging_leg).positions
    assert_allclose(result, expected, atol=1e-12)


def test_confidence_is_resampled():
    tracks = Tracks(("a",), np.zeros((3, 1, 3)), 10.0, np.array([[0.0], [1.0], [0.5]]))

    assert_allclose(resample(tracks, 20.0).confidence[:, 0], [0, 0.5, 1, 0.75, 0.5])


@pytest.mark.parametrize("rate", [0.0, -1.0, np.nan, np.inf])
def test_resample_raises_for_invalid_rates(swinging_leg, rate):
    with pytest.raises(
        InvalidMotionError, match=r"frame rate of .* is not that of a recording"
    ):
        resample(swinging_leg, rate)


def test_resample_does_not_modify_its_input(swinging_leg):
    before = swinging_leg.rotations.copy()

    resample(swinging_leg, 24.0)

    assert_allclose(swinging_leg.rotations, before, atol=0)
    assert isinstance(resample(swinging_leg, 24.0), Motion)
