"""The likelihood of a pose: all weighted image terms of the tracker."""

from collections.abc import Callable

from ..body import SurfaceRows, concatenate_rows
from .closest_surface import closest_surface_term
from .depth_image import depth_image_term
from .extra_depth import extra_depth_term
from .free_space import off_actor_term, too_near_term
from .hypothesis import Hypothesis
from .observation import Observation
from .pixel_groups import group_pixels
from .silhouette import silhouette_term
from .tracker_settings import TrackerSettings

POINT_STEP = 2
"""A count: every n-th observed point enters the closest surface term, with n times the weight.
It bounds the run time. Half and twice are no better (`make sensitivity`)."""
REFERENCE_AREA_M2 = 4e-4
"""Surface of a pixel for which the weights are specified. By definition."""


def likelihood_rows(
    hypothesis: Hypothesis,
    observation: Observation,
    settings: TrackerSettings,
) -> SurfaceRows:
    """Return the rows of all terms with a positive weight.

    Parameters
    ----------
    hypothesis : Hypothesis
    observation : Observation
    settings : TrackerSettings
    """
    groups = group_pixels(hypothesis, observation, settings.limit)
    area = pixel_area(observation) / REFERENCE_AREA_M2
    scale, limit = settings.robust_scale, settings.limit
    both = (hypothesis, observation)
    terms: tuple[tuple[float, Callable[[float], SurfaceRows]], ...] = (
        (settings.depth_weight, lambda w: depth_image_term(*both, groups, w)),
        (settings.extra_weight, lambda w: extra_depth_term(*both, groups, w, limit)),
        (settings.silhouette_weight, lambda w: silhouette_term(*both, w)),
        (settings.closest_weight,
         lambda w: closest_surface_term(
             hypothesis, observation.points[::POINT_STEP], POINT_STEP * w, scale)),
        (settings.off_actor_weight, lambda w: off_actor_term(*both, groups, w, scale)),
        (settings.too_near_weight, lambda w: too_near_term(*both, groups, w, scale)),
    )  # fmt: skip
    return concatenate_rows([term(area * weight) for weight, term in terms if weight > 0.0])


def pixel_area(observation: Observation) -> float:
    """Return the surface of a pixel at the actor's distance, square meters."""
    return observation.pixel_area
