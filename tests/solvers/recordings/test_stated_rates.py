"""Stamps with a stated rate next to them, as markers have: rounded, uneven or with holes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.recordings.conventions.time_stamps import ConstantRate, constant_rate_from_times


def line(times) -> np.ndarray:
    """A point that moves evenly in time, so that interpolation must be exact."""
    return np.asarray(times)[:, None, None] * (1.0, -2.0, 0.5)


@pytest.mark.parametrize(
    ("times", "stated_rate", "rate"),
    [
        (np.arange(300) / 120.0, 120.0, 120.0),
        (5.0 + np.arange(300) / 120.0, None, 120.0),
        (np.round(np.arange(900) / 400.0, 3), 400.0, 400.0),
        (np.round(np.arange(900) / 59.94, 2), 59.94, 59.94),
        (np.arange(300) / 100.0, 60.0, 100.0),
        (np.arange(300) / 100.0, 200.0, 100.0),
        (np.array([0.0, 0.02]), None, 50.0),
    ],
)
def test_even_time_stamps_change_nothing(times, stated_rate, rate):
    assert constant_rate_from_times(times, stated_rate) == pytest.approx(rate, rel=1e-12)


@pytest.mark.parametrize("stated_rate", [100.0, 70.0, None])
def test_skipped_frames_are_gaps(stated_rate):
    kept = np.r_[0:40, 43:80, 81:100]
    times = kept / 100.0

    assert constant_rate_from_times(times, stated_rate) is None
    clock = ConstantRate("take", times, stated_rate)
    found = clock.positions(line(times))

    assert clock.frame_rate == pytest.approx(100.0)
    assert len(found) == 100
    assert_array_equal(np.isnan(found).all(axis=(1, 2)), ~np.isin(np.arange(100), kept))
    assert_allclose(found[kept], line(times))


def test_uneven_stamps_are_resampled(rng):
    """The stamps wander by a fifth of a frame, and two frames in a row are missing."""
    wander = np.r_[0.0, rng.uniform(-0.2, 0.2, size=99)]
    times = np.delete((np.arange(100) + wander) / 30.0, [50, 51])

    clock = ConstantRate("take", times, 30.0)
    found = clock.positions(line(times))

    assert clock.frame_rate == 30.0
    expected = line(times[0] + np.arange(len(found)) / 30.0)
    assert len(found) in (99, 100)
    by_the_hole = np.arange(len(found))
    by_the_hole = (by_the_hole > 47) & (by_the_hole < 54)
    assert_allclose(found[~by_the_hole], expected[~by_the_hole], atol=1e-12)
    assert 1 <= np.isnan(found).all(axis=(1, 2)).sum() <= 4
    half_a_frame = np.abs((1.0, -2.0, 0.5)) / 60.0
    near = np.abs(found - expected)[by_the_hole]
    assert (near[np.isfinite(near).all(axis=(1, 2))] <= half_a_frame + 1e-12).all()


def test_a_leap_in_time_is_refused():
    times = np.array([0.0, 0.01, 0.02, 1e9])

    with pytest.raises(InvalidFileError, match=r"take: its 4 frames span 1e.09 s"):
        ConstantRate("take", times, 100.0)


def test_the_stated_rate_counts_where_frames_were_left_out():
    times = np.delete(np.arange(200), [50, 51]) / 119.88

    assert ConstantRate("take", times, 119.88).frame_rate == 119.88
    assert ConstantRate("take", times).frame_rate == 120.0
