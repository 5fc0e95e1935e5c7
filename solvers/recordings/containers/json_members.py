"""Large JSON files piece by piece, so that no more than one frame is held as objects."""

import json
import re
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from .text import read_bytes

SPACE = re.compile(r"[ \t\r\n]*")
DECODER = json.JSONDecoder()


class Member(NamedTuple):
    """A member of the outermost object, or one element of a member that is a list."""

    key: str
    value: Any
    done: float
    """Fraction of the file that ends with it."""


def json_members(path: Path | str) -> Iterator[Member]:
    """Yield the members of the file's one object, lists element by element.

    Raises InvalidFileError where the file is missing or no JSON object.
    """
    content = read_bytes(path)
    try:
        text = content.decode("utf-8")
        del content
        yield from _members(text)
    except (ValueError, RecursionError, IndexError):
        raise InvalidFileError(
            f"{path} is not readable as JSON: it is damaged or cut short. Export it again."
        ) from None


def _members(text: str) -> Iterator[Member]:
    at = _skip_mark(text, 0, "{")
    more = text[at] != "}"
    while more:
        key, at = DECODER.raw_decode(text, at)
        at = _skip_mark(text, at, ":")
        if text[at] == "[":
            at = yield from _elements(text, at, str(key))
        else:
            value, at = DECODER.raw_decode(text, at)
            yield Member(str(key), value, at / len(text))
        at = _skip_space(text, at)
        more = text[at] != "}"
        if more:
            at = _skip_mark(text, at, ",")


def _elements(text: str, at: int, key: str) -> Generator[Member, None, int]:
    at = _skip_mark(text, at, "[")
    more = text[at] != "]"
    while more:
        value, at = DECODER.raw_decode(text, at)
        yield Member(key, value, at / len(text))
        at = _skip_space(text, at)
        more = text[at] != "]"
        if more:
            at = _skip_mark(text, at, ",")
    return at + 1


def _skip_space(text: str, at: int) -> int:
    found = SPACE.match(text, at)
    return found.end() if found else at


def _skip_mark(text: str, at: int, mark: str) -> int:
    """Return the place after a mark and the space around it; ValueError where it is not."""
    at = _skip_space(text, at)
    if text[at] != mark:
        raise ValueError(mark)
    return _skip_space(text, at + 1)


def array_from_json(value: Any, shape: tuple[int, ...], place: str) -> NDArray[np.float64]:
    """Return nested lists of numbers as an array; null is NaN, and -1 in a shape any length.

    Raises InvalidFileError, which begins with `place`, for whatever else.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        array = np.empty(0)
    fits = array.ndim == len(shape) and all(
        wanted in {-1, size} for wanted, size in zip(shape, array.shape, strict=True)
    )
    if not fits:
        sizes = " x ".join("any number" if size < 0 else str(size) for size in shape) or "one"
        raise InvalidFileError(
            f"{place}: {sizes} numbers belong there. The file is damaged; export it again."
        )
    return array
