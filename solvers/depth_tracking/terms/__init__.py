"""The terms of the tracker's objective: how well a pose explains a depth image."""

from .closest_surface import closest_surface_term
from .depth_image import depth_image_term
from .free_space import off_actor_term
from .hypothesis import Hypothesis, capsule_offsets, imagine
from .likelihood import USUAL_AREA, likelihood_rows, pixel_area
from .observation import Observation, observe
from .pixel_groups import group_pixels
from .surface import Memory
from .tracker_settings import LOU12, USUAL, WZC12, TrackerSettings

__all__ = [
    "LOU12",
    "USUAL",
    "USUAL_AREA",
    "WZC12",
    "Hypothesis",
    "Memory",
    "Observation",
    "TrackerSettings",
    "capsule_offsets",
    "closest_surface_term",
    "depth_image_term",
    "group_pixels",
    "imagine",
    "likelihood_rows",
    "observe",
    "off_actor_term",
    "pixel_area",
]
