"""The benchmark of figure 2.2 of Lou's thesis counts the bases that the product learns."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import FilterBasesSettings, learn_filter_bases
from solvers.denoising.channels import encode
from solvers.samples import GaitSettings, walking_gait
from tests.benchmarks.denoise.part_bases import rebuilding_errors, with_almost_all

SHORT = FilterBasesSettings(window=0.2)


@pytest.fixture(scope="module")
def walks():
    return [
        walking_gait(GaitSettings(duration=4.0, frame_rate=30.0, speed=speed))
        for speed in (0.9, 1.2, 1.5)
    ]


@pytest.fixture(scope="module")
def published(walks):
    return learn_filter_bases(walks[:2], settings=SHORT)


def test_more_bases_begin_with_the_published_ones(walks, published):
    more = with_almost_all(published, walks[:2])

    n_published = len(published.vectors)
    assert len(more.vectors) > n_published
    assert_allclose(more.vectors[:n_published], published.vectors, atol=1e-6)


def test_error_falls_to_nothing_with_the_number_of_bases(walks, published):
    more = with_almost_all(published, walks[:2])

    errors = rebuilding_errors(more, walks[0], (1, 2, 4, len(more.vectors)))

    assert np.all(np.diff(errors) < 0.0)
    assert errors[-1] < 0.02 * errors[0]


def test_error_is_that_of_the_projection_on_the_bases(walks, published):
    """Window by window, as eq. 2.6 is written."""
    values = encode(walks[2], published.reference_of).flat - published.mean
    angles = np.setdiff1d(published.moving, np.arange(values.shape[1])[-3:])
    misses = []
    for start in range(len(values) - published.window + 1):
        window = values[start : start + published.window]
        rebuilt = sum(np.vdot(base, window) * base for base in published.vectors[:3])
        misses.append(np.abs(window - rebuilt)[:, angles].mean())

    (error,) = rebuilding_errors(published, walks[2], (3,))

    assert error == pytest.approx(np.mean(misses))
