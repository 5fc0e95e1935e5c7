"""The edge term of [LOU12]: edges of the drawn depth go to edges of the observed one."""

import numpy as np
from numpy.typing import NDArray

from ..body import NO_ROWS, SurfaceRows, rows_toward_targets
from .depth_edges import edge_pixels
from .hypothesis import Hypothesis
from .observation import Observation

Array = NDArray[np.float64]

WINDOW = 10
"""Pixels to each side that are searched, in a picture of 320 columns: 21 x 21."""


def edge_term(hypothesis: Hypothesis, observation: Observation, weight: float) -> SurfaceRows:
    """Return the rows of the edge term of [LOU12]_, eq. 3.8 and 3.9.

    Canny's edges of both pictures are lifted to points in space by the depth of their pixels;
    each observed edge point pulls the closest drawn one within a window of 21 x 21 pixels (of
    320 columns).

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    weight : float, per square metre

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.4.2.
    """
    width = observation.camera.width
    reach = max(1, round(WINDOW * width / 320.0))
    there = observation.edges
    drawn = hypothesis.index_picture[edge_pixels(hypothesis.picture.depth_picture())]
    if not (len(there) and len(drawn)):
        return NO_ROWS
    pixels = hypothesis.picture.pixels[drawn]
    rows = np.abs(there[:, np.newaxis] // width - pixels // width)
    columns = np.abs(there[:, np.newaxis] % width - pixels % width)
    targets, points = observation.points_at(there), hypothesis.points[drawn]
    apart = targets[:, np.newaxis] - points
    squares = np.einsum("nki,nki->nk", apart, apart)
    squares[np.maximum(rows, columns) > reach] = np.inf
    best = squares.argmin(axis=1)
    found = np.isfinite(squares[np.arange(len(there)), best])
    moved = drawn[best[found]]
    return rows_toward_targets(
        hypothesis.points[moved], targets[found], np.full(len(moved), weight),
        hypothesis.picture.capsules[moved],
    )  # fmt: skip
