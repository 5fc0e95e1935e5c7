"""Planted feet of the result of any workflow, and toes that lie flat."""

from .flatten_toes import flatten_toes
from .plant_feet_if_possible import PlantingResult, plant_feet_if_possible

__all__ = ["PlantingResult", "flatten_toes", "plant_feet_if_possible"]
