"""Read a recording of any supported format."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from ..depth_scene import DepthRecording
from ..errors import InvalidFileError, InvalidMotionError
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched, within
from .conventions import Bodies, Body, check_scale
from .depth_files import DepthSettings, detect_depth_format, read_depth
from .format_description import Format, Tracked
from .formats import detect_format
from .unknown_files import describe_unknown

OPENING_FRACTION = 0.9
"""Fraction of the time that passes until the bodies are known, in formats with several."""

Result = TypeVar("Result")


def read_recording(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Motion | Tracks | JointRecording | DepthRecording:
    """Read a recording of any supported format, detected from the content.

    Parameters
    ----------
    path : Path or str
        BVH; AMC with the ASF of the actor next to it; C3D; TRC; joints of depth cameras; depth
        images (docs/formats).
    scale : float, meters per unit of the file, or None
        None: the default of the format.
    body : str, optional
        Name or number of one of several bodies (`list_bodies`); by default the person in most
        frames. A message to `progress` names the others.
    progress : Progress

    Returns
    -------
    Motion, Tracks or JointRecording
        In meters, Z up; NaN where not observed.
    DepthRecording
        Depth images of a camera; see `read_depth` for more options.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or of an unsupported format.
    InvalidSettingError
        The scale is not positive, or there is no such body.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    if is_depth_recording(path):
        return read_depth(path, DepthSettings(scale=scale or 0.0), progress=progress)
    return read_tracked(path, scale=scale, body=body, progress=progress)


def list_bodies(path: Path | str, *, progress: Progress = unwatched) -> tuple[Body, ...]:
    """Return the bodies to choose from in a recording; empty where there is no choice.

    False detections are left out. Raises InvalidFileError as `read_tracked` does.
    """
    bodies = open_bodies(path, progress=progress)
    return tuple(bodies.listed[each] for each in bodies.offered)


def is_depth_recording(path: Path | str) -> bool:
    """Whether a file or folder contains depth images of a supported format.

    Raises InvalidFileError if it is missing or unreadable.
    """
    return detect_format(path) is None and detect_depth_format(path) is not None


def read_tracked(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Tracked:
    """Read a recording as `read_recording` does, without depth images.

    Raises
    ------
    InvalidFileError
        Also for a depth recording, which has no tracked motion yet.
    """
    bodies = open_bodies(path, scale=scale, progress=within(progress, 0.0, OPENING_FRACTION))
    start = OPENING_FRACTION if bodies.listed else 0.0
    return bodies.read_one(body, within(progress, start, 1.0))


def open_bodies(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Tracked]:
    """List the bodies of a recording; each can then be read.

    Raises
    ------
    InvalidFileError
        As `read_tracked`. Of a format with one body, damage is found when that is read.
    """
    return open_format(path, detect_format(path), scale, progress)


def open_format(
    path: Path | str, format_: Format | None, scale: float | None, progress: Progress
) -> Bodies[Tracked]:
    """List the bodies of a file of a detected format as `open_bodies` does; refuse None."""
    if format_ is None:
        raise _unknown_format(path)
    bodies = _valid(path, partial(format_.open, path, scale=scale), progress)
    together = bodies.read_together
    return replace(
        bodies,
        read=lambda index, progress: _valid(path, partial(bodies.read, index), progress),
        read_together=together and partial(_valid, path, together),
    )


def _valid(path: Path | str, read: Callable[..., Result], progress: Progress) -> Result:
    """Read; a valid format that holds no valid recording is an invalid file too."""
    try:
        return read(progress=progress)
    except InvalidMotionError as error:
        raise InvalidFileError(f"{path}: {error}") from None


def _unknown_format(path: Path | str) -> InvalidFileError:
    """Return why a file or folder of unknown format has no motion."""
    if detect_depth_format(path) is not None:
        return InvalidFileError(
            f"{path} has depth images but no motion yet. Track the actor in it first."
        )
    if Path(path).is_dir():
        return InvalidFileError(
            f"{path} is a folder without depth images. Choose a file in it."
        )
    unknown = (
        f"{path} has an unknown format. Export it as BVH, FBX, GLB, C3D, TRC or a table of"
        " joints."
    )
    return InvalidFileError(describe_unknown(path) or unknown)


def read_motion_or_tracks(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Motion | Tracks:
    """Read a recording as `read_tracked` does; return the joints of a camera as points."""
    recording = read_tracked(path, scale=scale, body=body, progress=progress)
    return recording.tracks if isinstance(recording, JointRecording) else recording
