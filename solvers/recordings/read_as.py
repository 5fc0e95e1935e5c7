"""Read a recording by settings for what its file may not say."""

from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched
from .conventions import lacks_floor, put_on_floor, question_of_size, reinterpreted
from .formats import detect_format
from .read_recording import read_format
from .reading_settings import DEFAULT_READING, Floor, ReadingSettings

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)


def read_as(
    path: Path | str,
    settings: ReadingSettings = DEFAULT_READING,
    *,
    scale: float | None = None,
    body: str | None = None,
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
    body : str, optional
        Which of several bodies (`read_recording`).
    floor : Floor
        Whether the take is moved onto the floor.
    progress : Progress
    """
    scale = settings.unit.metres if scale is None else scale
    format_ = detect_format(path)
    if format_ is not None and format_.lacks_bones:
        about: dict[str, Any] = {
            "height": settings.height,
            "on_floor": floor is not Floor.NEVER,
        }
        format_ = format_._replace(
            read=partial(format_.read, **about),
            open=format_.open and partial(format_.open, **about),
        )
    recording = read_format(path, format_, scale=scale, body=body, progress=progress)
    recording = settle(recording, settings, floor)
    if question := question_of_size(recording):
        progress(1.0, question)
    return recording


def settle(recording: Recording, settings: ReadingSettings, floor: Floor) -> Recording:
    """Return what was read in the axes of the settings, and on the floor where it has none."""
    if settings.up.axis or settings.forward.axis:
        recording = reinterpreted(recording, settings.up.axis, settings.forward.axis)
    if floor is Floor.ALWAYS or (floor is Floor.AUTO and lacks_floor(recording)):
        recording = put_on_floor(recording)
    return recording
