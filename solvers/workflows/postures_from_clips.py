"""Build a posture library from the clips of the user."""

from collections.abc import Sequence

from ..errors import InvalidMotionError
from ..motion import Motion, Tracks
from ..progress import Progress, unwatched
from ..reconstruction.pose_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
)

LIBRARY_SETTINGS = PostureLibrarySettings()


def posture_library_from_clips(
    clips: Sequence[Motion | Tracks],
    *,
    settings: PostureLibrarySettings = LIBRARY_SETTINGS,
    progress: Progress = unwatched,
) -> PostureLibrary:
    """Build a posture library from clean clips.

    Raises
    ------
    InvalidMotionError
        No clip has a skeleton, or one lacks hips, arms or legs.
    """
    motions = [clip for clip in clips if isinstance(clip, Motion)]
    if not motions:
        raise InvalidMotionError(
            "A posture library needs motions of skeletons; these clips are points."
            " Choose clips with a skeleton."
        )
    source = "1 clip of your own" if len(motions) == 1 else f"{len(motions)} clips of your own"
    return build_posture_library(
        motions, settings=settings, trained_on=source, progress=progress
    )
