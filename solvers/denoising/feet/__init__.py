"""Foot-skate cleanup: feet that stand are held in place."""

from .legs import SIDES, Leg, find_legs, foot_joints
from .plant_feet import Planted, PlantSettings, plant_feet

__all__ = ["SIDES", "Leg", "PlantSettings", "Planted", "find_legs", "foot_joints", "plant_feet"]
