"""The depth image term: difference of rendered and observed depth per pixel."""

import numpy as np

from ...arrays import Array
from ..body import SurfaceRows
from .hypothesis import Hypothesis
from .observation import Observation
from .pixel_groups import PixelGroups

_MIN_COSINE = 0.25
"""Minimum cosine between normal and ray; the gradient diverges at the outline. Chosen by hand;
`make sensitivity` varies it."""


def depth_image_term(
    hypothesis: Hypothesis, observation: Observation, groups: PixelGroups, weight: float
) -> SurfaceRows:
    """Return the rows of the depth image term of [WZC12]_, eq. 4 and 15.

    Only pixels that show the same part in both images count. Other terms handle pixels off
    the actor (B1) and pixels with a large depth difference (B2, occlusions). The image gradient
    of a rendered capsule follows exactly from its normal. A point that moves by m changes the
    depth of its pixel by (normal . m) / (normal . ray). With gradients this is
    (dD/dp - grad D dx/dp) m; the plus sign of eq. 15 disagrees with differences of rendered
    images.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square meter
        1 / sigma^2 of one pixel.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    chosen = groups.comparable
    residuals = (
        observation.flat[hypothesis.image.pixels[chosen]] - hypothesis.image.depths[chosen]
    )
    return SurfaceRows(
        hypothesis.points[chosen], depth_gradients(hypothesis)[chosen], residuals,
        np.full(len(chosen), weight), hypothesis.image.capsules[chosen],
    )  # fmt: skip


def depth_gradients(hypothesis: Hypothesis) -> Array:
    """Return the derivative of each pixel's depth by its visible point, (n, 3)."""
    normals, rays = hypothesis.normals, hypothesis.rays
    cosines = np.einsum("ni,ni->n", normals, rays)
    ray_lengths = np.sqrt(np.einsum("ni,ni->n", rays, rays))
    gradients: Array = normals / np.minimum(cosines, -_MIN_COSINE * ray_lengths)[:, np.newaxis]
    return gradients
