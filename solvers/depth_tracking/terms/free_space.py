"""Free-space terms: the body stays out of space that the camera observed as empty."""

import numpy as np

from ..body import SurfaceRows, rows_toward_targets
from .hypothesis import Hypothesis
from .observation import Observation, rays_through_pixels
from .pixel_groups import PixelGroups

_IMAGE_AXES = np.eye(3)[:2]


def off_actor_term(
    hypothesis: Hypothesis,
    observation: Observation,
    groups: PixelGroups,
    weight: float,
    scale: float,
) -> SurfaceRows:
    """Return rows that move visible points off the actor sideways onto it.

    The target is the nearest pixel of the actor, at the depth of the point. Weights fall by
    (1 + (distance / scale)^2)^2, so that distant points, as when a part of the image is
    missing, have little effect.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square meter
    scale : float, meters
    """
    chosen = groups.off_actor
    points = hypothesis.points[chosen]
    nearest = observation.nearest_pixel[hypothesis.image.pixels[chosen]]
    lateral_offsets = points[:, 2:] * rays_through_pixels(observation.camera, nearest) - points
    squared_distances = lateral_offsets[:, 0] ** 2 + lateral_offsets[:, 1] ** 2
    weights = weight / (1.0 + squared_distances / scale**2) ** 2
    return SurfaceRows(
        np.repeat(points, 2, axis=0), np.tile(_IMAGE_AXES, (len(points), 1)),
        lateral_offsets[:, :2].ravel(), np.repeat(weights, 2),
        np.repeat(hypothesis.image.capsules[chosen], 2),
    )  # fmt: skip


def too_near_term(
    hypothesis: Hypothesis,
    observation: Observation,
    groups: PixelGroups,
    weight: float,
    scale: float,
) -> SurfaceRows:
    """Return rows that move points far in front of the observation to the closest point.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square meter
    scale : float, meters
        As in `off_actor_term`.
    """
    chosen = groups.too_near
    points = hypothesis.points[chosen]
    distances, nearest = observation.tree.query(points)
    weights = weight / (1.0 + (distances / scale) ** 2) ** 2
    return rows_toward_targets(
        points, observation.points[nearest], weights, hypothesis.image.capsules[chosen]
    )
