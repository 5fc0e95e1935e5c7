"""Run the verb of `each` on one file, in a child Blender that ends with its parent."""

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
"""First argument of a child Blender."""
POLL_INTERVAL_S = 0.2
"""Seconds between two looks at the processes. It bounds the delay after each take."""
LOCK_TIMEOUT_S = 30.0
"""Seconds to wait for the lock of a Blender that is ending, before an error. It bounds the wait
for one that hangs."""


class ChildResult(NamedTuple):
    """The result of a child Blender."""

    status: int
    errors: str
    """Its output on stderr."""


def run_child(command: Sequence[str], target: Path, stopped: Event) -> ChildResult | None:
    """Run a Blender that makes `target`, and wait for its end.

    If another Blender still processes that file, for example after `each` was killed, wait for
    it first.

    Parameters
    ----------
    command : sequence of str
    target : Path
        The .blend file that it saves.
    stopped : Event
        If it is set, no Blender is started.

    Returns
    -------
    Ended or None
        None if it was not started.
    """
    while _is_locked(target):
        if stopped.wait(POLL_INTERVAL_S):
            return None
    with subprocess.Popen(
        command,
        stdin=subprocess.PIPE,  # nothing is written: it closes when this process ends
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
    ) as child:
        assert child.stderr is not None
        errors = child.stderr.read()  # not communicate(), which closes stdin at once
        return ChildResult(child.wait(), errors.decode("utf-8", "replace"))


@contextmanager
def lock_target(target: Path) -> Iterator[None]:
    """Lock `target` in a child Blender, and end this process with its parent.

    Raises
    ------
    InvalidFileError
        Another Blender processes that file.
    """
    end_with_stdin()
    path, until = lock_for_work_on(target), monotonic() + LOCK_TIMEOUT_S
    while (lock := try_lock(path)) is None:
        if monotonic() > until:
            raise InvalidFileError(
                f"Another Blender process is writing {target}; wait until it is done, or end"
                " it."
            )
        Event().wait(POLL_INTERVAL_S)
    try:
        yield
    finally:
        lock.release()


def _is_locked(target: Path) -> bool:
    lock = try_lock(lock_for_work_on(target))
    if lock is not None:
        lock.release()
    return lock is None
