"""Libraries of clips in memory or in an SQLite file."""

from .clip_library import ClipLibrary
from .library_file import refuse_other_suffix
from .open_library import (
    build_clip_library,
    libraries_in,
    load_clip_library,
    open_clip_library,
)

__all__ = [
    "ClipLibrary",
    "build_clip_library",
    "libraries_in",
    "load_clip_library",
    "open_clip_library",
    "refuse_other_suffix",
]
