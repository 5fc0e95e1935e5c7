"""Files that a job and its child process exchange in their folder."""

import errno
import pickle
import re
from enum import IntEnum
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

from ...solvers.faults import escaped

REQUEST, RESULT, LOG, SHOWN = "request", "result", "log", "shown"
TAIL = 4096  # bytes of the log that are read
SIZE = 8  # bytes of the length of a pickle
DISK_FULL = {errno.ENOSPC, errno.EDQUOT}
PROGRESS = re.compile(r"^@([01]\.\d+) (.*)$")

Result = TypeVar("Result")


class Ending(IntEnum):
    """Exit status of a child process. Neither a full disk nor memory can take more words."""

    ANSWERED = 0
    """The result, or what the solver raised, is on disk."""
    FAILED = 1
    """The log ends with a traceback."""
    OUT_OF_MEMORY = 3
    DISK_FULL = 4


class PreviewSolve(partial[Result]):
    """A solve that is also called with `show=`, a callback for previews."""


def append_shown(file: BinaryIO, thing: Any) -> None:
    """Append a picklable preview to the file that `read_shown` reads."""
    content = pickle.dumps(thing, protocol=pickle.HIGHEST_PROTOCOL)
    file.write(len(content).to_bytes(SIZE, "little") + content)
    file.flush()


def read_shown(folder: Path, start: int) -> tuple[list[Any], int]:
    """Return the previews after an offset in the file, and the next offset.

    A partly written or unreadable preview is left for the next call.
    """
    try:
        with (folder / SHOWN).open("rb") as file:
            file.seek(start)
            content = file.read()
    except OSError:
        return [], start
    things, offset = [], 0
    while offset + SIZE <= len(content):
        stop = offset + SIZE + int.from_bytes(content[offset : offset + SIZE], "little")
        if stop > len(content):
            break
        things.append(pickle.loads(content[offset + SIZE : stop]))
        offset = stop
    return things, start + offset


def progress_line(fraction: float, message: str) -> str:
    """Return the line of the log for the progress of a solver."""
    return escaped(f"@{min(max(fraction, 0.0), 1.0):.4f} {message}")


def last_progress(folder: Path) -> tuple[float, str]:
    """Return the last fraction and message in the log."""
    for line in reversed(_tail(folder)):
        if found := PROGRESS.match(line):
            return float(found[1]), found[2]
    return 0.0, "Starting"


def last_words(folder: Path) -> str:
    """Return the last line in the log that is not progress, such as the end of a traceback."""
    lines = [line for line in _tail(folder) if line.strip() and not PROGRESS.match(line)]
    return lines[-1] if lines else ""


def _tail(folder: Path) -> list[str]:
    try:
        with (folder / LOG).open("rb") as log:
            log.seek(max(log.seek(0, 2) - TAIL, 0))
            return log.read().decode("utf-8", "replace").splitlines()
    except OSError:
        return []
