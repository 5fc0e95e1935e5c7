"""Foot-skate cleanup: hold planted feet in place."""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .body_supports import find_supports
    from .legs import LegJoints, find_foot_joints, find_foot_points, find_legs
    from .live_planting import LivePlanting, PlantedPose
    from .plant_feet import Planted, plant_feet
    from .plant_settings import PlantSettings
    from .sole import HEEL_FRACTION, sole_points
    from .sole_contact import FootContact, find_foot_contact

__all__ = [
    "HEEL_FRACTION",
    "FootContact",
    "LegJoints",
    "LivePlanting",
    "PlantSettings",
    "Planted",
    "PlantedPose",
    "find_foot_contact",
    "find_foot_joints",
    "find_foot_points",
    "find_legs",
    "find_supports",
    "plant_feet",
    "sole_points",
]

import_on_demand(__name__)
