"""Define where tasks run: in processes of this machine, or elsewhere."""

from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from typing import Any, Protocol

from .workers import worker_pool


class Workers(Protocol):
    """Processes that run tasks."""

    batch: str
    """Identifier by which workers of other machines know each other's claims; empty on this
    machine, which knows its processes."""
    max_crashes: int
    """Number of crashes after which a task has failed; in its last attempt it runs alone."""
    advice: str
    """A sentence for the user whose task crashed."""

    def n_processes(self) -> int:
        """Return how many tasks they run at once now; workers may join and leave."""

    def open(self, n_tasks: int) -> AbstractContextManager[Executor]:
        """Yield an executor; its futures raise BrokenExecutor if the process crashed."""

    def share(self, value: Any) -> Any:
        """Return what a task receives in place of a value that all tasks use."""


@dataclass
class LocalWorkers:
    """Processes of this machine."""

    n_jobs: int
    n_threads: int
    batch: str = ""
    max_crashes: int = 3
    """A crash ends all tasks of the pool. Most of them finish in the second attempt."""
    advice: str = "Process a part of the take, or use fewer --jobs."

    def n_processes(self) -> int:
        """Return the number of jobs."""
        return self.n_jobs

    @contextmanager
    def open(self, n_tasks: int) -> Iterator[Executor]:
        """Yield a pool of new processes."""
        with worker_pool(min(self.n_jobs, n_tasks), self.n_threads) as pool:
            yield pool

    def share(self, value: Any) -> Any:
        """Return the value itself: it is pickled with each task."""
        return value
