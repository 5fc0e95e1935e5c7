"""Clips of a library, their origins, and the matches of a search."""

from dataclasses import dataclass
from unicodedata import category

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ..postures import Recording

LINE_BREAKS_AND_CONTROLS = {"Cc", "Zl", "Zp"}
"""Unicode categories that would break a terminal or a text file."""


@dataclass(frozen=True)
class Origin:
    """Source file of a clip, used to read it again and to detect changes."""

    path: str
    """Absolute path of the file."""
    item: str = ""
    """Name of the action in a file that Blender reads, or of one of several bodies; empty where
    the file holds one clip."""
    size: int = 0
    """Size of the file in bytes when it was indexed."""
    modified: int = 0
    """Modification time of the file in nanoseconds when it was indexed."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A recording with its name and tags in a library.

    Raises
    ------
    InvalidMotionError
        The name or a tag has control characters, or they or the origin are not valid UTF-8.
    """

    name: str
    recording: Recording
    tags: tuple[str, ...] = ()
    origin: Origin | None = None

    def __post_init__(self) -> None:
        if fault := find_text_fault(self.name):
            raise InvalidMotionError(f"The clip name {self.name!r} {fault}; rename it.")
        if fault := find_tags_fault(self.tags):
            raise InvalidMotionError(f"{self.name}: {fault}")
        path = "" if self.origin is None else self.origin.path
        if not is_utf_8(path):
            raise InvalidMotionError(
                f"{self.name}: its path {path!r} is not valid UTF-8; rename the folder."
            )


@dataclass(frozen=True)
class ClipEntry:
    """Metadata of a clip in a library, without its motion."""

    name: str
    tags: tuple[str, ...]
    origin: Origin | None
    n_frames: int
    frame_rate: float

    @property
    def seconds(self) -> float:
        """Duration in seconds."""
        return self.n_frames / self.frame_rate


@dataclass(frozen=True, eq=False)
class Match:
    """A clip that is similar to the query.

    Attributes
    ----------
    clip : str
        Its name in the library.
    frames : range
        Matching frames of the clip, at its own frame rate.
    score : float
        1 for the same motion, close to 0 for an unrelated motion.
    alignment : int, shape (n, 2), or None
        Pairs (frame of the query, frame of the clip), each at its own frame rate; None if it
        was not computed.
    """

    clip: str
    frames: range
    score: float
    alignment: NDArray[np.intp] | None = None


def find_text_fault(text: str) -> str:
    """Return why a text cannot be a clip name or tag, or an empty string."""
    if not is_utf_8(text):
        return "is not valid UTF-8"
    if any(category(letter) in LINE_BREAKS_AND_CONTROLS for letter in text):
        return "has control characters"
    return ""


def find_tags_fault(tags: tuple[str, ...]) -> str:
    """Return a message about tags with control characters or invalid UTF-8, or nothing."""
    wrong = [f"The tag {tag!r} {fault}." for tag in tags if (fault := find_text_fault(tag))]
    return " ".join([*wrong, "Choose another tag."]) if wrong else ""


def is_utf_8(text: str) -> bool:
    """Whether a text can be stored as UTF-8; Linux file names may have any bytes."""
    return all(category(letter) != "Cs" for letter in text)
