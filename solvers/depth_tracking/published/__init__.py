"""The trackers as published: presets and terms that the default does not use."""

from .edge_tracker import track_pose_by_edges
from .registration_tracker import REGISTRATION_TRACKER

__all__ = ["REGISTRATION_TRACKER", "track_pose_by_edges"]
