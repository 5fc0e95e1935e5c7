"""The trackers as published: presets and terms that the default does not use."""

from .edge_tracker import track_pose_by_edges
from .wzc12 import WZC12

__all__ = ["WZC12", "track_pose_by_edges"]
