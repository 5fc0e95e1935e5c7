"""Stamps decide when a frame was; the rate that comes out is constant."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.recordings.marker_times import at_constant_rate


def line(times) -> np.ndarray:
    """A point that moves evenly in time, so that interpolation must be exact."""
    return np.asarray(times)[:, None, None] * (1.0, -2.0, 0.5)


@pytest.mark.parametrize(
    ("times", "said", "rate"),
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
def test_even_stamps_change_nothing(times, said, rate):
    positions = line(times)

    found, found_rate = at_constant_rate(positions, times, said, "take")

    assert found is positions
    assert found_rate == pytest.approx(rate, rel=1e-12)


@pytest.mark.parametrize("said", [100.0, 70.0, None])
def test_frames_that_were_left_out_are_gaps(said):
    kept = np.r_[0:40, 43:80, 81:100]
    times = kept / 100.0

    found, rate = at_constant_rate(line(times), times, said, "take")

    assert rate == pytest.approx(100.0)
    assert len(found) == 100
    assert_array_equal(np.isnan(found).all(axis=(1, 2)), ~np.isin(np.arange(100), kept))
    assert_allclose(found[kept], line(times))


def test_uneven_stamps_are_resampled(rng):
    """The stamps wander by a third of a frame, and two frames in a row are missing."""
    wander = np.r_[0.0, rng.uniform(-0.35, 0.35, size=99)]
    times = np.delete((np.arange(100) + wander) / 30.0, [50, 51])

    found, rate = at_constant_rate(line(times), times, 30.0, "take")

    assert rate == 30.0
    expected = line(times[0] + np.arange(len(found)) / 30.0)
    known = np.isfinite(found)
    assert_allclose(found[known], expected[known], atol=1e-12)
    assert 1 <= np.isnan(found).all(axis=(1, 2)).sum() <= 4
    assert len(found) in (99, 100)


def test_a_leap_in_time_is_refused():
    times = np.array([0.0, 0.01, 0.02, 1e9])

    with pytest.raises(InvalidFileError, match=r"take: 4 frames are spread over 1e.09 s"):
        at_constant_rate(line(times), times, 100.0, "take")
