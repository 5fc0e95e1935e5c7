"""Banded matrices over time are those of the dense normal equations."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.signals import lower_block_bands


@pytest.mark.parametrize("n_frames", [1, 2, 3, 7])
def test_block_bands_equal_the_dense_matrix(rng, n_frames):
    n = 3
    factors = rng.normal(size=(n_frames, n, n))
    blocks = factors @ factors.transpose(0, 2, 1)
    between = rng.normal(size=(n_frames - 1, n, n))
    weights = rng.uniform(0.5, 2.0, size=n)
    differences = np.kron(np.diff(np.eye(n_frames), n=2, axis=0), np.diag(np.sqrt(weights)))
    dense = differences.T @ differences
    for frame in range(n_frames):
        here = slice(frame * n, (frame + 1) * n)
        dense[here, here] += blocks[frame]
        if frame + 1 < n_frames:
            later = slice((frame + 1) * n, (frame + 2) * n)
            dense[here, later] += between[frame]
            dense[later, here] += between[frame].T

    bands = lower_block_bands(blocks, weights, between)

    for below in range(min(2 * n + 1, n_frames * n)):
        assert_allclose(bands[below, : n_frames * n - below], np.diagonal(dense, -below))
