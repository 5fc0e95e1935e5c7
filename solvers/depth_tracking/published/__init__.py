"""The trackers as published: presets and terms that the default does not use."""

from .lou12 import track_pose_lou12
from .wzc12 import WZC12

__all__ = ["WZC12", "track_pose_lou12"]
