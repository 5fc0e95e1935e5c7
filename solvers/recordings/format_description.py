"""Description of a supported format."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched
from .conventions import Bodies

Tracked = Motion | Tracks | JointRecording


class Opener(Protocol):
    """Signature of what opens a file of a format."""

    def __call__(
        self, path: Path | str, /, *, scale: float | None = None, progress: Progress = unwatched
    ) -> Bodies[Tracked]:
        """List the bodies of a file; each can then be read."""


class Format(NamedTuple):
    """A supported format, with its detection from the first bytes and its reader."""

    name: str
    fits: Callable[[bytes], bool]
    open: Opener
    has_skeleton: bool = False
    """Whether it contains the motion of a skeleton; otherwise points."""
    has_markers: bool = False
    """Whether its points are markers; otherwise joints of a body."""
    is_refused: bool = False
    """Whether it is recognized only for a better sentence."""
    lacks_bones: bool = False
    """Whether it may hold the rotations of a body without lengths (`smpl_body`)."""
    is_one_frame: Callable[[Path], bool] | None = None
    """Whether a file holds one frame of a take with a file for each; None if none can."""


def one_body(read: Callable[..., Tracked]) -> Opener:
    """Return what opens files of a format with one body, by its reader."""

    def open_file(
        path: Path | str,
        /,
        *,
        scale: float | None = None,
        progress: Progress = unwatched,
        **about: Any,
    ) -> Bodies[Tracked]:
        reader = partial(read, path, scale=scale, **about)
        return Bodies(str(path), (), lambda _, progress: reader(progress=progress))

    return open_file
