"""Worker processes that end with the process that started them."""

import signal
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait

from .parent import end_after
from .threads import processes_with_threads


@contextmanager
def worker_pool(n_workers: int, n_threads: int = 1) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of processes, each with so many threads of linear algebra.

    The pool shuts down at the end. If this process is killed, its workers end within seconds.
    """
    with (
        processes_with_threads(n_threads),
        ProcessPoolExecutor(n_workers, get_context("spawn"), _begin) as pool,
    ):
        yield pool


def _begin() -> None:
    """Let Ctrl-C end a worker without a traceback: its parent reports it in one sentence."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    parent = parent_process()
    if parent is not None:
        end_after(lambda: wait([parent.sentinel]))
