"""The local median is that of SciPy, where values are more than half of a window."""

import pytest
from numpy.testing import assert_array_equal
from scipy.ndimage import median_filter

from solvers.signals import local_median


@pytest.mark.parametrize("n", [4, 5, 40])
@pytest.mark.parametrize("half_width", [0, 1, 3])
def test_local_median_is_that_of_scipy(rng, n, half_width):
    values = rng.normal(size=n)

    expected = median_filter(values, 2 * half_width + 1, mode="nearest")

    assert_array_equal(local_median(values, half_width), expected)
