"""What a job and its child process leave for each other in their folder."""

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
SIZE = 8  # bytes that tell how long a pickle is
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
    """A solve that is also called with `show=`, which takes what can be looked at meanwhile."""


def append_shown(file: BinaryIO, thing: Any) -> None:
    """Write something picklable where `read_shown` finds it."""
    told = pickle.dumps(thing, protocol=pickle.HIGHEST_PROTOCOL)
    file.write(len(told).to_bytes(SIZE, "little") + told)
    file.flush()


def read_shown(folder: Path, start: int) -> tuple[list[Any], int]:
    """Return what was shown since the file was that long, and how long it is now.

    What is only half written, or cannot be read now, is left for the next time.
    """
    try:
        with (folder / SHOWN).open("rb") as file:
            file.seek(start)
            told = file.read()
    except OSError:
        return [], start
    things, place = [], 0
    while place + SIZE <= len(told):
        stop = place + SIZE + int.from_bytes(told[place : place + SIZE], "little")
        if stop > len(told):
            break
        things.append(pickle.loads(told[place + SIZE : stop]))
        place = stop
    return things, start + place


def progress_line(fraction: float, message: str) -> str:
    """Return the line of the log that tells how far a solver is."""
    return escaped(f"@{min(max(fraction, 0.0), 1.0):.4f} {message}")


def last_progress(folder: Path) -> tuple[float, str]:
    """Return the last fraction and message in the log."""
    for line in reversed(_tail(folder)):
        if found := PROGRESS.match(line):
            return float(found[1]), found[2]
    return 0.0, "Starting"


def last_words(folder: Path) -> str:
    """Return the last line in the log that is not progress, such as the end of a traceback."""
    said = [line for line in _tail(folder) if line.strip() and not PROGRESS.match(line)]
    return said[-1] if said else ""


def _tail(folder: Path) -> list[str]:
    try:
        with (folder / LOG).open("rb") as log:
            log.seek(max(log.seek(0, 2) - TAIL, 0))
            return log.read().decode("utf-8", "replace").splitlines()
    except OSError:
        return []
