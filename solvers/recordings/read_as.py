"""Read a recording by settings for what its file may not say."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, Remark, unwatched, within
from .conventions import (
    Bodies,
    conventions_of,
    describe_guessed_axis,
    lacks_floor,
    level,
    put_on_floor,
    question_of_depth,
    question_of_floor,
    question_of_lean,
    question_of_size,
    refuse_single_point,
    reinterpreted,
    with_conventions,
)
from .format_description import Tracked
from .formats import detect_format
from .read_recording import OPENING_FRACTION, open_format
from .reading_settings import DEFAULT_READING, FloorPlacement, ReadingSettings

Recording = TypeVar("Recording", bound=Motion | Tracks | JointRecording)


def read_as(
    path: Path | str,
    settings: ReadingSettings = DEFAULT_READING,
    *,
    scale: float | None = None,
    body: str | None = None,
    floor: FloorPlacement = FloorPlacement.NEVER,
    progress: Progress = unwatched,
) -> Tracked:
    """Read a recording as `read_tracked` does, by settings for what the file may not say.

    What was estimated is in the `conventions` of the motion or tracks. `progress` receives a
    question where the actor is of an odd size.

    Parameters
    ----------
    path : Path or str
    settings : ReadingSettings
    scale : float, meters per unit of the file, or None
        None: the unit of the settings.
    body : str, optional
        Which of several bodies (`read_recording`).
    floor : FloorPlacement
        Whether the take is moved onto the floor.
    progress : Progress
    """
    opening = within(progress, 0.0, OPENING_FRACTION)
    bodies = open_as(path, settings, scale=scale, floor=floor, progress=opening)
    start = OPENING_FRACTION if bodies.listed else 0.0
    return bodies.read_one(body, within(progress, start, 1.0))


def open_as(
    path: Path | str,
    settings: ReadingSettings = DEFAULT_READING,
    *,
    scale: float | None = None,
    floor: FloorPlacement = FloorPlacement.NEVER,
    progress: Progress = unwatched,
) -> Bodies[Tracked]:
    """List the bodies of a recording; each is read as `read_as` does."""
    format_ = detect_format(path)
    if format_ is not None and format_.lacks_bones:
        about: dict[str, Any] = {
            "height": settings.height,
            "on_floor": floor is not FloorPlacement.NEVER,
        }
        format_ = format_._replace(open=partial(format_.open, **about))
    unit = settings.unit.meters if scale is None else scale
    bodies = open_format(path, format_, unit, progress)

    def settled(recording: Tracked, progress: Progress) -> Tracked:
        refuse_single_point(path, recording)
        if floor is not FloorPlacement.NEVER and settings.up.axis is None:
            recording = level(recording, progress)
        recording = settle(recording, settings, floor)
        for question in questions_of(recording, floor):
            progress(1.0, Remark(question))
        return recording

    together = bodies.read_together
    return replace(
        bodies,
        read=lambda index, progress: settled(bodies.read(index, progress), progress),
        read_together=together and (lambda progress: settled(together(progress), progress)),
    )


def settle(recording: Recording, settings: ReadingSettings, floor: FloorPlacement) -> Recording:
    """Return the recording in the axes of the settings, and on the floor where it has none."""
    if settings.up.axis or settings.forward.axis:
        recording = reinterpreted(recording, settings.up.axis, settings.forward.axis)
    if floor is FloorPlacement.AUTO and lacks_floor(recording):
        conventions = replace(conventions_of(recording), has_floor=False)
        recording = put_on_floor(with_conventions(recording, conventions))
    return put_on_floor(recording) if floor is FloorPlacement.ALWAYS else recording


def questions_of(recording: Tracked, floor: FloorPlacement) -> list[str]:
    """Ask whether size, depth, lean and height of an actor are right, and axes of markers.

    Heights are not questioned if the settings keep them.
    """
    conventions = conventions_of(recording)
    found = [
        question_of_size(recording),
        question_of_depth(recording),
        question_of_lean(recording),
    ]
    if isinstance(recording, Tracks) and not conventions.is_certain:
        found.append(describe_guessed_axis(conventions.up))
    if floor is not FloorPlacement.NEVER:
        found.append(question_of_floor(recording))
    return [question for question in found if question]
