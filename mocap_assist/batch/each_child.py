"""The Blender that does the verb of `each` to one file; it ends with its parent."""

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from threading import Event
from time import monotonic
from typing import NamedTuple

from ...solvers.errors import InvalidFileError
from ...solvers.processes import end_with_stdin, lock_for_work_on, try_lock

OPTION = "--child-of-each"
"""First word of the command line of such a Blender."""
BETWEEN_LOOKS = 0.2
"""Seconds."""
PATIENCE = 30.0
"""Seconds to wait for a Blender that is ending; one that works on is reported then."""


class Ended(NamedTuple):
    """How a Blender has ended."""

    status: int
    errors: str
    """What it has printed on stderr."""


def run_child(command: Sequence[str], target: Path, stopped: Event) -> Ended | None:
    """Run a Blender that makes `target`, and wait for its end.

    Where another one still works on that file, such as one whose `each` was killed a moment
    ago, its end is waited for first.

    Parameters
    ----------
    command : sequence of str
    target : Path
        The .blend file that it saves.
    stopped : Event
        Set when nobody wants the result any more: no Blender is started then.

    Returns
    -------
    Ended or None
        None where it was not started.
    """
    while _is_worked_on(target):
        if stopped.wait(BETWEEN_LOOKS):
            return None
    with subprocess.Popen(
        command,
        stdin=subprocess.PIPE,  # nothing is written: it closes when this process ends
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    ) as child:
        assert child.stderr is not None
        errors = child.stderr.read()  # not communicate(), which closes stdin at once
        return Ended(child.wait(), errors.decode("utf-8", "replace"))


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
