"""The scene of a depth recording: camera, floor, foreground and actor."""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .actor import Actor, find_actor
    from .bodies import label_components
    from .camera import Camera
    from .camera_checks import check_intrinsics
    from .causal_actor import CausalActor
    from .find_people import SeparatedPeople, find_people
    from .floor import LEVEL, FloorPlane, find_floor
    from .follow_several_people import level_distances
    from .foreground import ForegroundMethod, ForegroundSettings
    from .recording import ColorImage, DepthImage, DepthRecording
    from .share_pixels import NO_OWNER, enlarged, share_pixels

__all__ = [
    "LEVEL",
    "NO_OWNER",
    "Actor",
    "Camera",
    "CausalActor",
    "ColorImage",
    "DepthImage",
    "DepthRecording",
    "FloorPlane",
    "ForegroundMethod",
    "ForegroundSettings",
    "SeparatedPeople",
    "check_intrinsics",
    "enlarged",
    "find_actor",
    "find_floor",
    "find_people",
    "label_components",
    "level_distances",
    "share_pixels",
]

import_on_demand(__name__)
