"""Foot-skate cleanup: hold planted feet in place."""

from .legs import SIDES, Leg, find_foot_joints, find_legs
from .plant_feet import Planted, PlantSettings, plant_feet

__all__ = [
    "SIDES",
    "Leg",
    "PlantSettings",
    "Planted",
    "find_foot_joints",
    "find_legs",
    "plant_feet",
]
