"""The trackers of [WZC12] and [LOU12] as published: choices of *Track*.

The default tracker shares the code of both and differs where a benchmark shows a gain, so what
stands here stays as the papers print it.
"""

from .edge_tracker import EDGE_TRACKER, EdgeLikelihood, track_pose_by_edges
from .registration_tracker import REGISTRATION_TRACKER

__all__ = ["EDGE_TRACKER", "REGISTRATION_TRACKER", "EdgeLikelihood", "track_pose_by_edges"]
