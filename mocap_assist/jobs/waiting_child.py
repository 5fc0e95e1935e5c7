"""One process that waits for the next solve, so that a press answers fast.

It is used once: a solve never meets what another one has left behind.
"""

from contextlib import suppress

from ...solvers.errors import MocapAssistError
from .child_process import ChildProcess

_waiting: list[ChildProcess] = []
"""The process that waits, if any."""
_died_unused = [False]
"""Whether the last one ended by itself: none is started then until the next solve."""


def keep_waiting() -> None:
    """Start a process that waits, unless one does; without room for it nothing happens."""
    if is_waiting():
        return
    _died_unused[0] = _died_unused[0] or bool(_waiting)
    end_waiting()
    if _died_unused[0]:
        return
    with suppress(MocapAssistError, OSError, MemoryError):
        child = ChildProcess()
        try:
            child.start_waiting()
        except BaseException:
            child.abandon()
            raise
        _waiting.append(child)


def is_waiting() -> bool:
    """Return whether a process waits."""
    return any(child.is_waiting() for child in tuple(_waiting))


def take_waiting() -> ChildProcess | None:
    """Return the process that waits, for one solve; None if there is none.

    Any thread may call it: what it returns no other call returns or ends.
    """
    _died_unused[0] = False
    child = _pop()
    if child is None or child.is_waiting():
        return child
    child.abandon()
    return None


def end_waiting() -> None:
    """End the process that waits, if any."""
    while child := _pop():
        child.abandon()


def _pop() -> ChildProcess | None:
    with suppress(IndexError):
        return _waiting.pop()
    return None
