"""The scene of a depth recording: camera, floor, foreground and actor."""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .actor import Actor, find_actor
    from .camera import Camera
    from .camera_checks import check_intrinsics
    from .causal_actor import CausalActor
    from .floor import LEVEL, FloorPlane, find_floor
    from .foreground import ForegroundMethod, ForegroundSettings
    from .recording import ColorImage, DepthImage, DepthRecording

__all__ = [
    "LEVEL",
    "Actor",
    "Camera",
    "CausalActor",
    "ColorImage",
    "DepthImage",
    "DepthRecording",
    "FloorPlane",
    "ForegroundMethod",
    "ForegroundSettings",
    "check_intrinsics",
    "find_actor",
    "find_floor",
]

import_on_demand(__name__)
