"""End a process together with the one that started it, however that one ends.

A killed process cannot stop its children; they notice its end themselves, by a pipe or a
handle that the operating system closes. This works on Linux, macOS and Windows.
"""

import os
import sys
import threading
from collections.abc import Callable

ORPHANED = 1
"""Exit status of a process whose parent has ended."""
STDIN = 0


def nothing() -> None:
    """Clean up nothing."""


def end_with_stdin(clean_up: Callable[[], None] = nothing) -> None:
    """End this process once its standard input closes; the parent holds the other end.

    Parameters
    ----------
    clean_up : callable
        Called just before the process ends.
    """
    end_after(_stdin_closes, clean_up)


def end_after(event: Callable[[], object], clean_up: Callable[[], None] = nothing) -> None:
    """End this process at once when `event` returns; it waits in a thread of its own."""

    def watch() -> None:
        try:
            event()
            clean_up()
        finally:
            os._exit(ORPHANED)

    threading.Thread(target=watch, daemon=True, name="end with parent").start()


def exit_at_once(status: int) -> None:
    """End this process at once, after its output is flushed; nothing else is waited for."""
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, ValueError):  # the disk is full, or the stream is closed
            continue
    os._exit(status)


def _stdin_closes() -> None:
    # Not sys.stdin.read(): a thread that waits in it aborts Python when the program ends.
    while os.read(STDIN, 1):
        pass
