"""Reconstruction by postures alone, until both ways are combined."""

from dataclasses import replace

from ..motion import JointRecording
from ..progress import Progress, unwatched
from ..reconstruction.follow_joints import follow_joints
from ..reconstruction.posture_library import PostureLibrary
from ..reconstruction.posture_settings import PostureSettings
from ..reconstruction.reconstruct_postures import reconstruct_postures
from ..reconstruction.result import Reconstruction

ReconstructSettings = PostureSettings
USUAL = PostureSettings()


def reconstruct(
    recording: JointRecording,
    postures: PostureLibrary | None = None,
    prior: None = None,
    *,
    settings: ReconstructSettings = USUAL,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Rebuild postures, and let a skeleton follow them."""
    found = reconstruct_postures(recording, postures, settings=settings, progress=progress)
    motion = follow_joints(found.tracks, recording.parents, found.confidence)
    return replace(found, motion=motion)
