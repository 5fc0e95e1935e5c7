"""The silhouette image term: the outlines of body and actor should agree."""

import numpy as np
from numpy.typing import NDArray

from ..body import SurfaceRows
from .hypothesis import Hypothesis
from .observation import Observation

Array = NDArray[np.float64]


def silhouette_term(
    hypothesis: Hypothesis, observation: Observation, weight: float
) -> SurfaceRows:
    """Return the rows of the silhouette image term of [WZC12]_, eq. 6 and 16.

    The drawn silhouette is 1 inside and 0 outside; by central differences its gradient is not
    zero only beside the outline, and only those pixels of the body count. A point that moves
    towards the inside takes silhouette away where it was: its pixel changes by
    -grad S . dx/dp m, here as in the depth image term.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    weight : float
        1 / sigma^2 of one pixel, whose silhouettes are 0 or 1.
    """
    camera = observation.camera
    drawn = np.zeros((camera.height + 2, camera.width + 2))
    inner = drawn[1:-1, 1:-1]
    inner[:] = (hypothesis.index_picture >= 0).reshape(inner.shape)
    across = 0.5 * (drawn[1:-1, 2:] - drawn[1:-1, :-2]).ravel()
    down = 0.5 * (drawn[2:, 1:-1] - drawn[:-2, 1:-1]).ravel()
    pixels = hypothesis.picture.pixels
    chosen = np.flatnonzero((across[pixels] != 0.0) | (down[pixels] != 0.0))
    pixels, points = pixels[chosen], hypothesis.points[chosen]
    residuals = (observation.flat[pixels] > 0.0) - 1.0
    return SurfaceRows(
        points, -picture_gradients(across[pixels], down[pixels], points, hypothesis),
        residuals, np.full(len(chosen), weight), hypothesis.picture.capsules[chosen],
    )  # fmt: skip


def picture_gradients(
    across: Array, down: Array, points: Array, hypothesis: Hypothesis
) -> Array:
    """Return grad . dx/dp (n, 3): what a slope per pixel is per metre that a point moves."""
    camera = hypothesis.picture.camera
    x, y, z = points.T
    right, lower = across * camera.fx / z, down * camera.fy / z
    return np.stack([right, lower, -(right * x + lower * y) / z], axis=1)
