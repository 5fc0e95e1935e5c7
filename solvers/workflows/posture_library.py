"""Postures to rebuild from, of whatever clips an animator has."""

from collections.abc import Sequence

from ..errors import InvalidMotionError
from ..motion import Motion, Tracks
from ..progress import Progress, unwatched
from ..reconstruction.pose_library import (
    PostureLibrary,
    PostureLibrarySettings,
    build_posture_library,
)

USUAL = PostureLibrarySettings()


def posture_library_from_clips(
    clips: Sequence[Motion | Tracks],
    *,
    settings: PostureLibrarySettings = USUAL,
    progress: Progress = unwatched,
) -> PostureLibrary:
    """Build a library of the postures of clean clips.

    Raises
    ------
    InvalidMotionError
        There is no clip of a skeleton, or one lacks hips, arms or legs.
    """
    motions = [clip for clip in clips if isinstance(clip, Motion)]
    if not motions:
        raise InvalidMotionError(
            "Postures are learned from the motions of skeletons; these clips are points."
        )
    said = "1 clip of your own" if len(motions) == 1 else f"{len(motions)} clips of your own"
    return build_posture_library(motions, settings=settings, trained_on=said, progress=progress)
