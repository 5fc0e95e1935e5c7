"""Manifests: lists of the inputs of a batch, and of their outputs."""

import errno
import json
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from ...errors import InvalidFileError
from ...files import is_missing, reason_of
from ...json_text import parse_json

KEYS = {"input", "output"}
MAX_BYTES = 1 << 24
"""Bytes of a manifest. It bounds memory and time for other files and for devices that never
end; 16 MiB are the paths of 100,000 takes. Pipes are read, as of `<(find ...)`."""


class Listed(NamedTuple):
    """An input in a manifest."""

    path: Path
    name: Path
    """Its path relative to the manifest's folder, or else its name."""
    output: Path | None
    """The output relative to the output folder, if the manifest names it."""


def read_manifest(path: Path) -> list[Listed]:
    """Return the inputs in a manifest.

    The file has one path per line, or one JSON object `{"input": ..., "output": ...}` per line;
    a file `*.json` has a list of them.

    Raises
    ------
    InvalidFileError
        The manifest cannot be read or is empty, or one of its lines is invalid, or an input is
        missing.
    """
    try:
        text = _content(path).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except OSError as error:
        raise InvalidFileError(
            f"The manifest {path} cannot be read: {reason_of(error)}."
        ) from None
    except UnicodeDecodeError as error:
        line = error.object[: error.start].count(b"\n") + 1
        raise InvalidFileError(
            f"The manifest {path}, line {line}: it is not UTF-8 text."
        ) from None
    listed = []
    for position, entry in _entries(path, text):
        try:
            listed.append(_parse_entry(path.parent, entry))
        except ValueError as error:
            raise InvalidFileError(f"The manifest {path}, {position}: {error}.") from None
    if not listed:
        raise InvalidFileError(f"The manifest {path} names no recording.")
    return listed


def _content(path: Path) -> bytes:
    with path.open("rb") as file:
        content = file.read(MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        reason = f"it has more than {MAX_BYTES >> 20} MiB; divide it"
        raise OSError(errno.EFBIG, reason, str(path))
    return content


def _entries(path: Path, text: str) -> Iterator[tuple[str, Any]]:
    """Yield the position of each entry, and the entry: a path, or a value of the JSON."""
    if path.suffix.lower() == ".json":
        entries = _parsed(path, text, 1)
        if not isinstance(entries, list):
            raise InvalidFileError(f"The manifest {path}, line 1: it must be a list [...].")
        yield from ((f"entry {number}", entry) for number, entry in enumerate(entries, 1))
        return
    for number, line in enumerate(text.split("\n"), start=1):
        entry = line.strip()
        if entry.startswith("{"):
            yield f"line {number}", _parsed(path, entry, number)
        elif entry:
            yield f"line {number}", entry


def _parsed(path: Path, text: str, first_line: int) -> Any:
    try:
        return parse_json(text)
    except ValueError as error:
        line, reason = first_line, str(error)
        if isinstance(error, json.JSONDecodeError):
            line, reason = first_line + error.lineno - 1, error.msg
        raise InvalidFileError(
            f"The manifest {path}, line {line}: it is not JSON ({reason})."
        ) from None


def _parse_entry(folder: Path, entry: Any) -> Listed:
    """Return an entry; a ValueError says what is wrong with it."""
    if isinstance(entry, str):
        entry = {"input": entry}
    if not isinstance(entry, dict) or not {"input"} <= set(entry) <= KEYS:
        raise ValueError('it must be a path, or {"input": PATH, "output": PATH}')
    if not all(isinstance(text, str) and text and "\0" not in text for text in entry.values()):
        raise ValueError("input and output must be paths")
    path = folder / entry["input"]
    if is_missing(path):
        raise ValueError(f"there is no file {path}")
    name, output = Path(entry["input"]), entry.get("output")
    if not _is_below(name):
        name = Path(name.name)
    if output is not None and not _is_below(Path(output)):
        raise ValueError(f"the output {output} is not below the output folder")
    if output is not None and path.is_dir():
        raise ValueError(f"{path} is a folder, and has many outputs")
    return Listed(path, name, None if output is None else Path(output))


def _is_below(path: Path) -> bool:
    parts = {*path.parts, *PurePosixPath(path.as_posix()).parts}
    return bool(path.name) and not path.anchor and ".." not in parts
