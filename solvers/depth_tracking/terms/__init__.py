"""The terms of the tracker's objective: how well a pose explains a depth image."""

from .closest_surface import closest_surface_term
from .depth_image import depth_image_term
from .free_space import off_actor_term
from .hypothesis import Hypothesis, capsule_offsets, render_hypothesis
from .likelihood import REFERENCE_AREA_M2, likelihood_rows, pixel_area
from .observation import Observation, observe, subsampling_step
from .pixel_groups import group_pixels
from .tracker_settings import DEFAULT_TRACKER, TrackerSettings

__all__ = [
    "DEFAULT_TRACKER",
    "REFERENCE_AREA_M2",
    "Hypothesis",
    "Observation",
    "TrackerSettings",
    "capsule_offsets",
    "closest_surface_term",
    "depth_image_term",
    "group_pixels",
    "likelihood_rows",
    "observe",
    "off_actor_term",
    "pixel_area",
    "render_hypothesis",
    "subsampling_step",
]
