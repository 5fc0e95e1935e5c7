"""What a library is made of, and what a search finds in it."""

from dataclasses import dataclass
from unicodedata import category

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ..postures import Recording

LINE_BREAKS_AND_CONTROLS = {"Cc", "Zl", "Zp"}
"""Categories of Unicode that no name needs, and that a terminal or a text file obeys."""


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
    """A recording with a name by which a library knows it.

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


def find_text_fault(text: str) -> str:
    """Return what keeps a text from being a clip's name or tag, or nothing."""
    if not is_utf_8(text):
        return "is not valid UTF-8"
    if any(category(letter) in LINE_BREAKS_AND_CONTROLS for letter in text):
        return "has control characters"
    return ""


def find_tags_fault(tags: tuple[str, ...]) -> str:
    """Return a sentence about tags that have control characters or are not UTF-8."""
    wrong = [f"The tag {tag!r} {fault}." for tag in tags if (fault := find_text_fault(tag))]
    return " ".join([*wrong, "Choose another word."]) if wrong else ""


def is_utf_8(text: str) -> bool:
    """Whether a text, such as a path, can be stored; file names of Linux may be any bytes."""
    return all(category(letter) != "Cs" for letter in text)
