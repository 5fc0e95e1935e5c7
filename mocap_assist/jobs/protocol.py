"""Files that a job and its child process exchange in their folder."""

import errno
import pickle
import re
from contextlib import suppress
from enum import IntEnum
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

from ...solvers.faults import escaped

REQUEST, RESULT, LOG, PREVIEWS = "request", "result", "log", "previews"
GOES_ON = "goes on"
"""An `EndableSolve` ends once this file is removed, which works on a full disk, too."""
WAIT = "wait"
"""Argument of child.py: the request is written later."""
TAIL_BYTES = 4096
LENGTH_BYTES = 8  # of the length before each pickle or array
MAX_PREVIEWS_BYTES = 1 << 20
"""Size from which the previews of an `EndableSolve` go on in another file, so that Blender can
remove those it has shown. It bounds the space of hours: a file has about two seconds."""
DISK_FULL = {errno.ENOSPC, errno.EDQUOT}
PROGRESS = re.compile(r"^@([01]\.\d+) (.*)$")

Result = TypeVar("Result")


class Ending(IntEnum):
    """Exit status of a child process; it needs neither disk space nor memory."""

    ANSWERED = 0
    """The result, or the solver's exception, is on disk."""
    FAILED = 1
    """The log ends with a traceback."""
    OUT_OF_MEMORY = 3
    DISK_FULL = 4


class PreviewSolve(partial[Result]):
    """A solve that is also called with `show=`, a callback for previews."""


class EndableSolve(PreviewSolve[Result]):
    """A solve that is also called with `is_ended=`, whether to end with the result so far."""


def write_value(path: Path, value: Any) -> None:
    """Write a picklable value; arrays go to the file without a copy in memory."""
    buffers: list[pickle.PickleBuffer] = []
    content = pickle.dumps(value, pickle.HIGHEST_PROTOCOL, buffer_callback=buffers.append)
    with path.open("wb") as file:
        for block in (memoryview(content), *(buffer.raw() for buffer in buffers)):
            file.write(block.nbytes.to_bytes(LENGTH_BYTES, "little"))
            file.write(block)


def read_value(path: Path) -> Any:
    """Return what `write_value` wrote; other threads run while arrays are read."""
    blocks = []
    with path.open("rb") as file:
        while length := file.read(LENGTH_BYTES):
            block = bytearray(int.from_bytes(length, "little"))
            file.readinto(block)
            blocks.append(block)
    return pickle.loads(blocks[0], buffers=blocks[1:])


def append_preview(file: BinaryIO, preview: Any) -> None:
    """Append a picklable preview to the file that `read_previews` reads."""
    content = pickle.dumps(preview, protocol=pickle.HIGHEST_PROTOCOL)
    file.write(len(content).to_bytes(LENGTH_BYTES, "little") + content)
    file.flush()


class EndlessPreviews:
    """Appends previews to files that `read_previews` reads, one after the other.

    The solve goes on without previews if they cannot be written, such as on a full disk.

    Parameters
    ----------
    folder : Path
    """

    def __init__(self, folder: Path) -> None:
        self._folder, self._number = folder, 0
        self._file: BinaryIO | None = previews_file(folder, 0).open("wb")

    def __call__(self, preview: Any) -> None:
        """Append a picklable preview."""
        if self._file is None:
            return
        try:
            append_preview(self._file, preview)
            if self._file.tell() >= MAX_PREVIEWS_BYTES:
                self._file.close()
                self._number += 1
                self._file = previews_file(self._folder, self._number).open("wb")
        except OSError:  # What is half written is never read.
            self.close()

    def close(self) -> None:
        """Append nothing more."""
        file, self._file = self._file, None
        if file is not None:
            with suppress(OSError):
                file.close()


def previews_file(folder: Path, number: int) -> Path:
    """Return the file of previews with a number; only `EndlessPreviews` has several."""
    return folder / f"{PREVIEWS}{number or ''}"


def read_previews(folder: Path, start: int, number: int = 0) -> tuple[list[Any], int]:
    """Return the previews after an offset in a file, and the next offset.

    A partly written or unreadable preview is left for the next call.
    """
    try:
        with previews_file(folder, number).open("rb") as file:
            file.seek(start)
            content = file.read()
    except OSError:
        return [], start
    previews, offset = [], 0
    while offset + LENGTH_BYTES <= len(content):
        stop = (
            offset
            + LENGTH_BYTES
            + int.from_bytes(content[offset : offset + LENGTH_BYTES], "little")
        )
        if stop > len(content):
            break
        previews.append(pickle.loads(content[offset + LENGTH_BYTES : stop]))
        offset = stop
    return previews, start + offset


def progress_line(fraction: float, message: str) -> str:
    """Return the line of the log for the progress of a solver."""
    return escaped(f"@{min(max(fraction, 0.0), 1.0):.4f} {message}")


def last_progress(folder: Path) -> tuple[float, str]:
    """Return the last fraction and message in the log."""
    for line in reversed(_tail(folder)):
        if match := PROGRESS.match(line):
            return float(match[1]), match[2]
    return 0.0, "Starting"


def last_output(folder: Path) -> str:
    """Return the last line in the log that is not progress, such as the end of a traceback."""
    lines = [line for line in _tail(folder) if line.strip() and not PROGRESS.match(line)]
    return lines[-1] if lines else ""


def _tail(folder: Path) -> list[str]:
    try:
        with (folder / LOG).open("rb") as log:
            log.seek(max(log.seek(0, 2) - TAIL_BYTES, 0))
            return log.read().decode("utf-8", "replace").splitlines()
    except OSError:
        return []
