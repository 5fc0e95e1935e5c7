"""The Blender that does the verb of `each` to one file; it ends with its parent."""

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from time import monotonic

from ...solvers.errors import InvalidFileError
from ...solvers.processes.locks import try_lock
from ...solvers.processes.parent import end_with_stdin
from ...solvers.processes.scratch import lock_for_work_on

OPTION = "--child-of-each"
"""First word of the command line of such a Blender."""
BETWEEN_LOOKS = 0.2
"""Seconds."""
PATIENCE = 30.0
"""Seconds to wait for a Blender that is ending; one that works on is reported then."""


def run_child(command: Sequence[str], target: Path, errors: Path, stopped: Event) -> int | None:
    """Run a Blender that makes `target`, and wait for its end.

    Where another one still works on that file, such as one whose `each` was killed a moment
    ago, its end is waited for first.

    Parameters
    ----------
    command : sequence of str
    target : Path
        The .blend file that it saves.
    errors : Path
        The file that takes what it prints on stderr.
    stopped : Event
        Set when nobody wants the result any more: no Blender is started then.

    Returns
    -------
    int or None
        Exit status; None where it was not started.
    """
    while _is_worked_on(target):
        if stopped.wait(BETWEEN_LOOKS):
            return None
    with errors.open("wb") as log:
        child = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,  # nothing is written: it closes when this process ends
            stdout=subprocess.DEVNULL,
            stderr=log,
        )
        with child:  # not communicate(), which closes stdin at once
            return child.wait()


@contextmanager
def working_on(target: Path) -> Iterator[None]:
    """Be such a Blender: end with the one that started it, and keep others off `target`.

    Raises
    ------
    InvalidFileError
        Another Blender works on that file.
    """
    end_with_stdin()
    path, until = lock_for_work_on(target), monotonic() + PATIENCE
    while (lock := try_lock(path)) is None:
        if monotonic() > until:
            raise InvalidFileError(
                f"Another Blender is making {target}; wait until it is done, or end it."
            )
        Event().wait(BETWEEN_LOOKS)
    try:
        yield
    finally:
        lock.release()


def _is_worked_on(target: Path) -> bool:
    lock = try_lock(lock_for_work_on(target))
    if lock is not None:
        lock.release()
    return lock is None
