"""The silhouette image term: difference of the silhouettes of body and actor."""

import numpy as np

from ...arrays import Array
from ..body import SurfaceRows
from .hypothesis import Hypothesis
from .observation import Observation


def silhouette_term(
    hypothesis: Hypothesis, observation: Observation, weight: float
) -> SurfaceRows:
    """Return the rows of the silhouette image term of [WZC12]_, eq. 6 and 16.

    The rendered silhouette is 1 inside and 0 outside. Its central differences are nonzero only
    at the outline, and only those pixels of the body count. A point that moves by m toward the
    inside changes its pixel by -grad S . dx/dp m, as in the depth image term.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    weight : float
        1 / sigma^2 of one pixel, whose silhouettes are 0 or 1.
    """
    camera = observation.camera
    silhouette = np.zeros((camera.height + 2, camera.width + 2))
    inner = silhouette[1:-1, 1:-1]
    inner[:] = (hypothesis.index_image >= 0).reshape(inner.shape)
    across = 0.5 * (silhouette[1:-1, 2:] - silhouette[1:-1, :-2]).ravel()
    down = 0.5 * (silhouette[2:, 1:-1] - silhouette[:-2, 1:-1]).ravel()
    pixels = hypothesis.image.pixels
    chosen = np.flatnonzero((across[pixels] != 0.0) | (down[pixels] != 0.0))
    pixels, points = pixels[chosen], hypothesis.points[chosen]
    residuals = (observation.flat[pixels] > 0.0) - 1.0
    return SurfaceRows(
        points, -point_gradients(across[pixels], down[pixels], points, hypothesis),
        residuals, np.full(len(chosen), weight), hypothesis.image.capsules[chosen],
    )  # fmt: skip


def point_gradients(across: Array, down: Array, points: Array, hypothesis: Hypothesis) -> Array:
    """Return grad . dx/dp (n, 3): image gradients per meter of point movement."""
    camera = hypothesis.image.camera
    x, y, z = points.T
    right, lower = across * camera.fx / z, down * camera.fy / z
    return np.stack([right, lower, -(right * x + lower * y) / z], axis=1)
