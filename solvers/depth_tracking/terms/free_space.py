"""Where the camera looked through, there is no body."""

import numpy as np
from numpy.typing import NDArray

from ..body import SurfaceRows, rows_toward_targets
from .hypothesis import Hypothesis
from .observation import Observation, rays_through_pixels
from .pixel_groups import PixelGroups

Array = NDArray[np.float64]

_SIDEWAYS = np.eye(3)[:2]


def off_actor_term(
    hypothesis: Hypothesis,
    observation: Observation,
    groups: PixelGroups,
    weight: float,
    scale: float,
) -> SurfaceRows:
    """Ask visible points that no pixel of the actor shows to move sideways onto the actor.

    The target is the pixel of the actor nearest in the picture, at the point's own depth.
    Weights fall by (1 + (distance / scale)^2)^2, so that what is far outside, as when a part of
    the picture is missing, does not tear.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square metre
    scale : float, metres
    """
    chosen = groups.off_actor
    points = hypothesis.points[chosen]
    nearest = observation.nearest_pixel[hypothesis.picture.pixels[chosen]]
    aside = points[:, 2:] * rays_through_pixels(observation.camera, nearest) - points
    squares = aside[:, 0] ** 2 + aside[:, 1] ** 2
    weights = weight / (1.0 + squares / scale**2) ** 2
    return SurfaceRows(
        np.repeat(points, 2, axis=0), np.tile(_SIDEWAYS, (len(points), 1)),
        aside[:, :2].ravel(), np.repeat(weights, 2),
        np.repeat(hypothesis.picture.capsules[chosen], 2),
    )  # fmt: skip


def too_near_term(
    hypothesis: Hypothesis,
    observation: Observation,
    groups: PixelGroups,
    weight: float,
    scale: float,
) -> SurfaceRows:
    """Ask visible points far in front of what was observed to move to the closest observed one.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    groups : PixelGroups
    weight : float, per square metre
    scale : float, metres
        As in `off_actor_term`.
    """
    chosen = groups.too_near
    points = hypothesis.points[chosen]
    distances, nearest = observation.tree.query(points)
    weights = weight / (1.0 + (distances / scale) ** 2) ** 2
    return rows_toward_targets(
        points, observation.points[nearest], weights, hypothesis.picture.capsules[chosen]
    )
