"""The depth image term: drawn and observed depth should agree, pixel by pixel."""

import numpy as np
from numpy.typing import NDArray

from ..body import SurfaceRows
from .hypothesis import Hypothesis
from .observation import Observation
from .pixel_groups import PixelGroups

Array = NDArray[np.float64]

_GRAZING = 0.25
"""Least cosine between normal and ray; nearer the outline, depth changes without bound."""


def depth_image_term(
    hypothesis: Hypothesis, observation: Observation, groups: PixelGroups, weight: float
) -> SurfaceRows:
    """Return the rows of the depth image term of [WZC12]_, eq. 4 and 15.

    Only pixels that show the same part in both pictures count: those off the actor (B1) and
    those whose depths are far apart (B2, occlusions) are left to other terms. The image
    gradient of a drawn capsule is known exactly from its normal, and is not taken by
    differences: a point that moves by m changes the depth that its pixel sees by
    (normal . m) / (normal . ray). Written with gradients that is
    (dD/dp - grad D dx/dp) m; the plus sign of eq. 15 does not agree with differences of
    drawn pictures.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square metre
        1 / sigma^2 of one pixel.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    chosen = groups.comparable
    residuals = (
        observation.flat[hypothesis.picture.pixels[chosen]] - hypothesis.picture.depths[chosen]
    )
    return SurfaceRows(
        hypothesis.points[chosen], depth_gradients(hypothesis)[chosen], residuals,
        np.full(len(chosen), weight), hypothesis.picture.capsules[chosen],
    )  # fmt: skip


def depth_gradients(hypothesis: Hypothesis) -> Array:
    """Return how the depth that a pixel sees changes when its visible point moves, (n, 3)."""
    normals, rays = hypothesis.normals, hypothesis.rays
    along = np.einsum("ni,ni->n", normals, rays)
    size = np.sqrt(np.einsum("ni,ni->n", rays, rays))
    gradients: Array = normals / np.minimum(along, -_GRAZING * size)[:, np.newaxis]
    return gradients
