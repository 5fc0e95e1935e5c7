"""What is known of a supported format."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched
from .conventions import Bodies

Tracked = Motion | Tracks | JointRecording


class Reader(Protocol):
    """Signature of the reader of a format."""

    def __call__(
        self, path: Path | str, /, *, scale: float | None = None, progress: Progress = unwatched
    ) -> Tracked:
        """Read a file."""


class BodiesReader(Protocol):
    """Signature of the reader of a format that may hold several bodies."""

    def __call__(
        self, path: Path | str, /, *, scale: float | None = None, progress: Progress = unwatched
    ) -> Bodies[Tracked]:
        """List the bodies of a file."""


class Format(NamedTuple):
    """A supported format, with its reader and its detection from the first bytes."""

    name: str
    fits: Callable[[bytes], bool]
    read: Reader
    has_skeleton: bool = False
    """Whether it contains the motion of a skeleton; otherwise points."""
    has_markers: bool = False
    """Whether its points are markers; otherwise joints of a body."""
    is_refused: bool = False
    """Whether it is recognized only for a better sentence."""
    lacks_bones: bool = False
    """Whether it may hold the rotations of a body without lengths (`smpl_body`)."""
    open: BodiesReader | None = None
    """Of a format that may hold several bodies."""
