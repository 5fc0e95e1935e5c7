"""Optical markers: correct labels, constrain rigid clusters, and solve a skeleton.

>>> from solvers.markers import find_marker_set
>>> found = find_marker_set(["Anna:LFWT", "Anna:RFWT", "Anna:LBWT", "Anna:RBWT"])
>>> found.name, found.subject, found.markers["LASI"]
('CMU 41', 'Anna:', 'Anna:LFWT')
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .constrain_clusters import ConstrainedMarkers, constrain_clusters
    from .marker_sets import MarkerSet, find_marker_set
    from .marker_sticks import find_marker_sticks
    from .model_outputs import find_model_outputs
    from .rigid_clusters import Cluster, ClusterSettings, find_rigid_clusters
    from .solve_skeleton import SolvedSkeleton, SolveSettings, solve_skeleton
    from .unswap import Swap, Unswapped, UnswapSettings, unswap_markers

__all__ = [
    "Cluster",
    "ClusterSettings",
    "ConstrainedMarkers",
    "MarkerSet",
    "SolveSettings",
    "SolvedSkeleton",
    "Swap",
    "UnswapSettings",
    "Unswapped",
    "constrain_clusters",
    "find_marker_set",
    "find_marker_sticks",
    "find_model_outputs",
    "find_rigid_clusters",
    "solve_skeleton",
    "unswap_markers",
]

import_on_demand(__name__)
