"""What a library is made of, and what a search finds in it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .clip_postures import Recording


@dataclass(frozen=True)
class Origin:
    """Where a clip came from, to read it again and to notice that it has changed."""

    path: str
    """File, absolute."""
    item: str = ""
    """Name of the action in a .blend file; empty where the file holds one clip."""
    size: int = 0
    """Of the file in bytes, when it was indexed."""
    modified: int = 0
    """Time of the file's last change in nanoseconds, when it was indexed."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A recording with a name by which a library knows it."""

    name: str
    recording: Recording
    tags: tuple[str, ...] = ()
    origin: Origin | None = None


@dataclass(frozen=True)
class ClipEntry:
    """What a library tells of a clip without its motion."""

    name: str
    tags: tuple[str, ...]
    origin: Origin | None
    n_frames: int
    frame_rate: float

    @property
    def seconds(self) -> float:
        """How long it lasts."""
        return self.n_frames / self.frame_rate


@dataclass(frozen=True, eq=False)
class Match:
    """A clip that is like the query.

    Attributes
    ----------
    clip : str
        Its name in the library.
    frames : range
        Of the clip, in its own frames: what of it is like the query.
    score : float
        1 for the same motion, towards 0 for what has nothing in common with it.
    alignment : int, shape (n, 2), or None
        Pairs (frame of the query, frame of the clip), both in their own frames; None where
        it was not worked out.
    """

    clip: str
    frames: range
    score: float
    alignment: NDArray[np.intp] | None = None
