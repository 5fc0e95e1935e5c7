"""Clean poses to learn from, and the nearest of them to a measured one."""

from .neighbors import PostureIndex, Query, index_postures, nearest_postures
from .posture_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
    joined_postures,
    load_posture_library,
)

__all__ = [
    "PostureIndex",
    "PostureLibrary",
    "PostureLibrarySettings",
    "Query",
    "build_posture_library",
    "index_postures",
    "joined_postures",
    "load_posture_library",
    "nearest_postures",
]
