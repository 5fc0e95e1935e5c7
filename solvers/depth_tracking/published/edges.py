"""The edge term of [LOU12]: rendered depth edges match observed ones."""

import numpy as np

from ...arrays import Integers
from ..body import NO_ROWS, SurfaceRows, rows_toward_targets
from ..terms import Hypothesis, Observation
from .depth_edges import edge_pixels

WINDOW_RADIUS_PX = 10
"""Half size of the search window at 320 columns: 21 x 21 pixels."""


def edge_term(
    hypothesis: Hypothesis, observation: Observation, observed_pixels: Integers, weight: float
) -> SurfaceRows:
    """Return the rows of the edge term of [LOU12]_, eq. 3.8 and 3.9.

    Canny edges of both images are back-projected to points. Each observed edge point pulls
    the closest rendered one within a window of 21 x 21 pixels (at 320 columns).

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    observed_pixels : shape (n,)
        Its `edge_pixels`.
    weight : float, per square meter

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.4.2.
    """
    width = observation.camera.width
    reach = max(1, round(WINDOW_RADIUS_PX * width / 320.0))
    rendered = hypothesis.index_image[edge_pixels(hypothesis.image.depth_image())]
    if not (len(observed_pixels) and len(rendered)):
        return NO_ROWS
    pixels = hypothesis.image.pixels[rendered]
    rows = np.abs(observed_pixels[:, np.newaxis] // width - pixels // width)
    columns = np.abs(observed_pixels[:, np.newaxis] % width - pixels % width)
    targets, points = observation.points_at(observed_pixels), hypothesis.points[rendered]
    offsets = targets[:, np.newaxis] - points
    squares = np.einsum("nki,nki->nk", offsets, offsets)
    squares[np.maximum(rows, columns) > reach] = np.inf
    best = squares.argmin(axis=1)
    has_match = np.isfinite(squares[np.arange(len(observed_pixels)), best])
    moved = rendered[best[has_match]]
    return rows_toward_targets(
        hypothesis.points[moved], targets[has_match], np.full(len(moved), weight),
        hypothesis.image.capsules[moved],
    )  # fmt: skip
