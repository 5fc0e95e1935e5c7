"""Describe a clip for a library, small enough to be sent between processes."""

from dataclasses import dataclass

from ...errors import InvalidMotionError
from ...motion import JointRecording
from ..postures import ClipPostures, clip_postures
from .clip import Clip, ClipEntry
from .clip_segments import CLIP_RATE_HZ


@dataclass(frozen=True, eq=False)
class DescribedClip:
    """A clip as a library stores it."""

    entry: ClipEntry
    postures: ClipPostures
    """At 20 Hz."""


def describe_clip(clip: Clip) -> DescribedClip:
    """Describe a clip for a library.

    Raises
    ------
    InvalidMotionError
        No body is recognized; the message begins with the name of the clip.
    """
    recording = clip.recording
    frames = recording.tracks if isinstance(recording, JointRecording) else recording
    try:
        postures = clip_postures(recording, CLIP_RATE_HZ)
    except InvalidMotionError as error:
        raise InvalidMotionError(f"{clip.name}: {error}") from None
    return DescribedClip(
        ClipEntry(clip.name, clip.tags, clip.origin, frames.n_frames, frames.frame_rate),
        postures,
    )
