"""Read a recording by settings for what its file may not say."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched
from .conventions import (
    conventions_of,
    lacks_floor,
    put_on_floor,
    question_of_size,
    reinterpreted,
    with_conventions,
)
from .read_recording import detect_format, read_format
from .reading_settings import DEFAULT_READING, Floor, ReadingSettings

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)


def read_as(
    path: Path | str,
    settings: ReadingSettings = DEFAULT_READING,
    *,
    scale: float | None = None,
    floor: Floor = Floor.NEVER,
    progress: Progress = unwatched,
) -> Motion | Tracks | JointRecording:
    """Read a recording as `read_tracked` does, by settings for what the file may not say.

    What was judged is in the `conventions` of the motion or tracks. `progress` receives a
    question where the actor is of an odd size.

    Parameters
    ----------
    path : Path or str
    settings : ReadingSettings
    scale : float, meters per unit of the file, or None
        None: the unit of the settings.
    floor : Floor
        Whether the take is moved onto the floor.
    progress : Progress
    """
    scale = settings.unit.metres if scale is None else scale
    format_ = detect_format(path)
    if format_ is not None and format_.lacks_bones:
        on_floor = floor is not Floor.NEVER
        read: Any = format_.read
        format_ = format_._replace(
            read=partial(read, height=settings.height, on_floor=on_floor)
        )
    recording = read_format(path, format_, scale, progress)
    recording = settle(recording, settings, floor)
    if question := question_of_size(recording):
        progress(1.0, question)
    return recording


def settle(recording: Recording, settings: ReadingSettings, floor: Floor) -> Recording:
    """Return what was read in the axes of the settings, and on the floor where it has none."""
    if settings.up.axis or settings.forward.axis:
        recording = reinterpreted(recording, settings.up.axis, settings.forward.axis)
    if floor is Floor.AUTO and lacks_floor(recording):
        conventions = replace(conventions_of(recording), has_floor=False)
        recording = put_on_floor(with_conventions(recording, conventions))
    return put_on_floor(recording) if floor is Floor.ALWAYS else recording
