"""One process that waits for the next solve, so that a press answers fast.

It is used once: a solve never meets what another one has left behind.
"""

from contextlib import suppress

from ...solvers.errors import MocapAssistError
from .child_process import ChildProcess

_waiting: list[ChildProcess] = []
"""None or one."""


def keep_waiting() -> None:
    """Start a process that waits, unless one does; without room for it nothing happens."""
    if _waiting and _waiting[0].is_waiting():
        return
    end_waiting()
    with suppress(MocapAssistError, OSError, MemoryError):
        child = ChildProcess()
        try:
            child.start_waiting()
        except BaseException:
            child.abandon()
            raise
        _waiting.append(child)


def take_waiting() -> ChildProcess | None:
    """Return the process that waits, for one solve; None if there is none."""
    if not _waiting:
        return None
    if _waiting[0].is_waiting():
        return _waiting.pop()
    end_waiting()
    return None


def end_waiting() -> None:
    """End the process that waits, if any."""
    while _waiting:
        _waiting.pop().abandon()
