"""What a depth camera saw: camera, recording, floor, foreground and the actor in it."""

from .actor import Actor, find_actor
from .camera import Camera
from .camera_checks import camera_doubts
from .floor import LEVEL, Floor, find_floor
from .foreground import ForegroundSettings, ForegroundWay
from .recording import ColorPicture, DepthPicture, DepthRecording

__all__ = [
    "LEVEL",
    "Actor",
    "Camera",
    "ColorPicture",
    "DepthPicture",
    "DepthRecording",
    "Floor",
    "ForegroundSettings",
    "ForegroundWay",
    "camera_doubts",
    "find_actor",
    "find_floor",
]
