"""Clean poses to learn from, and the search for the nearest ones."""

from .neighbors import PostureIndex, PostureQuery, index_postures, nearest_postures
from .posture_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
    load_posture_library,
    merge_posture_libraries,
)

__all__ = [
    "PostureIndex",
    "PostureLibrary",
    "PostureLibrarySettings",
    "PostureQuery",
    "build_posture_library",
    "index_postures",
    "load_posture_library",
    "merge_posture_libraries",
    "nearest_postures",
]
