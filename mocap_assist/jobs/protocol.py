"""What a job and its child process leave for each other in their folder."""

import re
from pathlib import Path

REQUEST, RESULT, LOG = "request", "result", "log"
TAIL = 4096  # bytes of the log that are read
PROGRESS = re.compile(r"^@([01]\.\d+) (.*)$")


def progress_line(fraction: float, message: str) -> str:
    """Return the line of the log that tells how far a solver is."""
    return f"@{min(max(fraction, 0.0), 1.0):.4f} {message}"


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
    except FileNotFoundError:
        return []
