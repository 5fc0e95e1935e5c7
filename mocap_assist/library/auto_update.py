"""Automatic updates of libraries: a thread watches their sources, Index updates them."""

import logging
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ..runtime.watch import why_busy
from .auto_update_list import auto_updated_libraries
from .background import Indexing, message_of, why_indexing
from .solve_indexing import IndexProblem, index_sources

logger = logging.getLogger(__name__)

CHECK_INTERVAL_S = 15.0
"""Seconds between two looks at the folders of a library. It bounds the load of a network
drive."""
INDEXING_INTERVAL_S = 0.25
"""Seconds between two queries of the background job. It bounds the delay of its progress."""
Files = frozenset[tuple[str, int, int]]
"""Path, size and time of each."""


class SourceWatcher:
    """Watches the sources of one library for changes that are complete."""

    def __init__(self, problem: IndexProblem) -> None:
        self.problem = problem
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._scan: Future[Files] | None = None
        self._scanned: Files | None = None
        self._indexed: Files | None = None

    def has_changed(self) -> bool:
        """Evaluate the last scan of the sources and start another one, without waiting.

        Returns
        -------
        bool
            Whether the files differ from the indexed ones and did not change between scans.
        """
        if self._scan is not None and not self._scan.done():
            return False
        files = self._scan.result() if self._scan is not None else None
        settled = files is not None and files == self._scanned != self._indexed
        self._scanned = files
        self._scan = self._thread.submit(files_of, self.problem)
        return settled

    def indexed(self) -> None:
        """Record that the files of the last scan are indexed, or cannot be."""
        self._indexed = self._scanned

    def stop(self) -> None:
        """Stop watching."""
        self._thread.shutdown(wait=False, cancel_futures=True)


def files_of(problem: IndexProblem) -> Files:
    """Return the files of the sources, except those of the library itself.

    Inaccessible files are left out; Index reports them.
    """
    library = Path(os.path.realpath(problem.library))
    files = (path for source in problem.sources for path in _files(source.path))
    # SQLite keeps files of its own next to the library, whose names begin with the library's.
    others = (
        path
        for path in files
        if path.parent != library.parent or not path.name.startswith(library.name)
    )
    return frozenset(signature for path in others if (signature := _file_signature(path)))


def _files(source: str) -> Iterator[Path]:
    """Yield the files of a source; unlike rglob, this tolerates inaccessible folders."""
    root = os.path.realpath(source)
    n_folders = 0
    for folder, _, names in os.walk(root):
        n_folders += 1
        yield from (Path(folder, name) for name in names)
    if n_folders == 0:
        yield Path(root)


def _file_signature(path: Path) -> tuple[str, int, int] | None:
    try:
        stat = path.stat()
    except (OSError, ValueError):  # It was deleted meanwhile, or is inaccessible.
        return None
    return str(path), stat.st_size, stat.st_mtime_ns


_watchers: dict[IndexProblem, SourceWatcher] = {}
_running: list[tuple[SourceWatcher, Indexing]] = []


def update_libraries() -> float:
    """Index a library with changed sources; return the seconds until the next check.

    Only this user's permissions list the libraries, never the open file.
    """
    listed = auto_updated_libraries()
    for problem in [each for each in _watchers if each not in listed]:
        _watchers.pop(problem).stop()
    if _running:
        _follow_indexing(*_running[0])
    elif not (why_indexing() or why_busy()):
        _start(listed)
    return INDEXING_INTERVAL_S if _running else CHECK_INTERVAL_S


def _start(listed: list[IndexProblem]) -> None:
    """Start to index the first library that needs it."""
    for problem in listed:
        if problem not in _watchers:
            _watchers[problem] = SourceWatcher(problem)
        if not _running and _watchers[problem].has_changed():
            indexing = Indexing(bpy.context, partial(index_sources, problem))
            _running.append((_watchers[problem], indexing))


def _follow_indexing(watcher: SourceWatcher, indexing: Indexing) -> None:
    """Show the progress of the running Index; end it when its library is unlisted."""
    if not indexing.is_on:  # Another file was loaded: it begins again.
        _running.clear()
    elif watcher.problem not in _watchers:
        _running.clear()
        indexing.abandon(bpy.context)
    elif not indexing.job.done():
        indexing.show(bpy.context)
    else:
        _running.clear()
        watcher.indexed()
        indexing.end(bpy.context, _message_of(indexing))


def _message_of(indexing: Indexing) -> str:
    try:
        return message_of(indexing.job.result())
    except MocapAssistError as error:
        return str(error)
    except Exception:  # A timer that raises is never called again.
        logger.exception("A library could not be kept current")
        return "The library could not be updated. Press Build Library to see why."


def register() -> None:
    """Start the checks; timers run only with a window."""
    bpy.app.timers.register(update_libraries, first_interval=CHECK_INTERVAL_S, persistent=True)


def unregister() -> None:
    """Stop the checks."""
    if bpy.app.timers.is_registered(update_libraries):
        bpy.app.timers.unregister(update_libraries)
    _running.clear()
    while _watchers:
        _watchers.popitem()[1].stop()
