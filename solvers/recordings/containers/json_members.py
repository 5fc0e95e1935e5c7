"""Parse large JSON files incrementally, with one frame in memory as objects."""

import json
import re
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...json_text import parse_json
from .frame_files import frame_files
from .text import read_bytes

SPACE = re.compile(r"[ \t\r\n]*")
DECODER = json.JSONDecoder()


class JsonMember(NamedTuple):
    """A member of the outermost object, or one element of a list member."""

    key: str
    value: Any
    done: float
    """Fraction of the file up to its end."""


def json_members(path: Path | str, *, lists: bool = False) -> Iterator[JsonMember]:
    """Yield the members of the outermost object, lists element by element.

    With `lists`, the outermost value may be a list, whose elements have an empty key, or there
    may be one in each line.

    Raises InvalidFileError if the file is missing or not a JSON object.
    """
    content = read_bytes(path)
    try:
        text = content.decode("utf-8")
        del content
        start = _skip_space(text, 0)
        if lists and _has_lines(text, start):
            yield from _lines(text, start)
        elif lists and text[start] == "[":
            yield from _elements(text, start, "")
        else:
            yield from _members(text)
    except (ValueError, RecursionError, IndexError):
        raise _damaged(path) from None


def json_content(path: Path | str, done: float = 1.0) -> JsonMember:
    """Return the content of a small file, with an empty key.

    Raises InvalidFileError if the file is missing or not JSON.
    """
    content = read_bytes(path)
    try:
        text = content.decode("utf-8")
        if _has_lines(text, _skip_space(text, 0)):
            return JsonMember("", [line.value for line in _lines(text, 0)], done)
        return JsonMember("", parse_json(text), done)
    except (ValueError, RecursionError):
        raise _damaged(path) from None


def json_frame_files(path: Path | str) -> Iterator[JsonMember]:
    """Yield the content of each file of a take with a file per frame (`frame_files`).

    The value of a frame without a file is None. Raises InvalidFileError for a damaged file.
    """
    frames = frame_files(path).frames()
    for count, file in enumerate(frames, start=1):
        done = count / len(frames)
        yield JsonMember("", None, done) if file is None else json_content(file, done)


def _damaged(path: Path | str) -> InvalidFileError:
    return InvalidFileError(
        f"{path} is not readable as JSON: it is damaged or cut short. Export it again."
    )


def _has_lines(text: str, start: int) -> bool:
    """Return whether a text has a value of JSON in each line, as loggers write."""
    end = text.find("\n", start)
    if end < 0 or text[end - 2 : end].strip()[-1:] not in {"}", "]"}:
        return False
    following = _skip_space(text, end)
    if text[following : following + 1] not in {"{", "["}:
        return False
    try:
        return DECODER.raw_decode(text, start)[1] <= end
    except ValueError:
        return False


def _lines(text: str, at: int) -> Iterator[JsonMember]:
    at = _skip_space(text, at)
    while at < len(text):
        value, at = DECODER.raw_decode(text, at)
        yield JsonMember("", value, at / len(text))
        at = _skip_space(text, at)


def _members(text: str) -> Iterator[JsonMember]:
    at = _skip_mark(text, 0, "{")
    more = text[at] != "}"
    while more:
        key, at = DECODER.raw_decode(text, at)
        at = _skip_mark(text, at, ":")
        if text[at] == "[":
            at = yield from _elements(text, at, str(key))
        else:
            value, at = DECODER.raw_decode(text, at)
            yield JsonMember(str(key), value, at / len(text))
        at = _skip_space(text, at)
        more = text[at] != "}"
        if more:
            at = _skip_mark(text, at, ",")


def _elements(text: str, at: int, key: str) -> Generator[JsonMember, None, int]:
    at = _skip_mark(text, at, "[")
    more = text[at] != "]"
    while more:
        value, at = DECODER.raw_decode(text, at)
        yield JsonMember(key, value, at / len(text))
        at = _skip_space(text, at)
        more = text[at] != "]"
        if more:
            at = _skip_mark(text, at, ",")
    return at + 1


def _skip_space(text: str, at: int) -> int:
    space = SPACE.match(text, at)
    return space.end() if space else at


def _skip_mark(text: str, at: int, mark: str) -> int:
    """Return the index after a mark and its surrounding space; ValueError if it is missing."""
    at = _skip_space(text, at)
    if text[at] != mark:
        raise ValueError(mark)
    return _skip_space(text, at + 1)


def array_from_json(value: Any, shape: tuple[int, ...], location: str) -> NDArray[np.float64]:
    """Return nested lists of numbers as an array; null becomes NaN.

    A length of -1 in the shape matches any length. Other values raise InvalidFileError, with a
    message that begins with the location.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (ValueError, TypeError, OverflowError):
        array = np.empty(0)
    fits = array.ndim == len(shape) and all(
        expected in {-1, size} for expected, size in zip(shape, array.shape, strict=True)
    )
    if not fits:
        sizes = " x ".join("any number" if size < 0 else str(size) for size in shape) or "one"
        raise InvalidFileError(
            f"{location}: {sizes} numbers are required. The file is damaged; export it again."
        )
    return array
