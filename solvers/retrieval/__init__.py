"""Index clips in a library, and find clips that are similar to a motion.

>>> from solvers.retrieval import Clip, build_clip_library, find_similar
>>> from solvers.samples import GaitSettings, walking_gait
>>> fast, slow = (walking_gait(GaitSettings(duration=2.0, cadence=c)) for c in (130, 100))
>>> library = build_clip_library([Clip("fast", fast), Clip("slow", slow)])
>>> find_similar(slow, library)[0].clip
'slow'
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .find_in_libraries import FoundClip, find_in_libraries
    from .find_similar import find_similar
    from .index import Clip, ClipEntry, DescribedClip, Match, Origin, describe_clip
    from .library import (
        ClipLibrary,
        build_clip_library,
        libraries_in,
        load_clip_library,
        open_clip_library,
    )
    from .search import FindMethod, FindSettings

__all__ = [
    "Clip",
    "ClipEntry",
    "ClipLibrary",
    "DescribedClip",
    "FindMethod",
    "FindSettings",
    "FoundClip",
    "Match",
    "Origin",
    "build_clip_library",
    "describe_clip",
    "find_in_libraries",
    "find_similar",
    "libraries_in",
    "load_clip_library",
    "open_clip_library",
]

import_on_demand(__name__)
