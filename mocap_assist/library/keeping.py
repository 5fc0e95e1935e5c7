"""Libraries that are kept current: a thread looks after their sources, Index does the rest."""

import logging
import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ..runtime.watch import why_busy
from .background import Indexing, message_of, why_indexing
from .kept_libraries import auto_updated_libraries
from .solve_indexing import IndexProblem, index_places

logger = logging.getLogger(__name__)

BETWEEN_LOOKS = 15.0  # seconds
WHILE_INDEXING = 0.25  # seconds
Files = frozenset[tuple[str, int, int]]
"""Path, size and time of each."""


class Keeper:
    """Watches the sources of one library for changes that are complete."""

    def __init__(self, problem: IndexProblem) -> None:
        self.problem = problem
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._look: Future[Files] | None = None
        self._seen: Files | None = None
        self._indexed: Files | None = None

    def wants(self) -> bool:
        """Evaluate the last look at the sources and start another one, without waiting.

        Returns
        -------
        bool
            What is there differs from what was indexed, and was the same twice.
        """
        if self._look is not None and not self._look.done():
            return False
        found = self._look.result() if self._look is not None else None
        settled = found is not None and found == self._seen != self._indexed
        self._seen = found
        self._look = self._thread.submit(files_of, self.problem)
        return settled

    def indexed(self) -> None:
        """Note that what was seen last is in the library, or cannot be."""
        self._indexed = self._seen

    def stop(self) -> None:
        """Look no more."""
        self._thread.shutdown(wait=False, cancel_futures=True)


def files_of(problem: IndexProblem) -> Files:
    """Return what lies in the places that are indexed, but for the library itself.

    What cannot be looked at is as if it were not there: Index will say so.
    """
    own = Path(os.path.realpath(problem.library))
    files = (path for place in problem.places for path in _files(place.path))
    # SQLite keeps files of its own next to the library, whose names begin with the library's.
    others = (
        path
        for path in files
        if path.parent != own.parent or not path.name.startswith(own.name)
    )
    return frozenset(seen for path in others if (seen := _seen(path)))


def _files(place: str) -> Iterator[Path]:
    """Yield what lies there; unlike rglob and is_dir, these bear what cannot be looked at."""
    whole = os.path.realpath(place)
    n_folders = 0
    for folder, _, names in os.walk(whole):
        n_folders += 1
        yield from (Path(folder, name) for name in names)
    if n_folders == 0:
        yield Path(whole)


def _seen(path: Path) -> tuple[str, int, int] | None:
    try:
        found = path.stat()
    except (OSError, ValueError):  # It went while we looked, or may not be looked at.
        return None
    return str(path), found.st_size, found.st_mtime_ns


_keepers: dict[IndexProblem, Keeper] = {}
_running: list[tuple[Keeper, Indexing]] = []


def look() -> float:
    """Index a kept library whose sources have changed; return the seconds until the next look.

    Which libraries those are says this user alone, never the file that is open.
    """
    kept = auto_updated_libraries()
    for problem in [each for each in _keepers if each not in kept]:
        _keepers.pop(problem).stop()
    if _running:
        _attend(*_running[0])
    elif not (why_indexing() or why_busy()):
        _start(kept)
    return WHILE_INDEXING if _running else BETWEEN_LOOKS


def _start(kept: list[IndexProblem]) -> None:
    """Start to index the first library that needs it."""
    for problem in kept:
        if problem not in _keepers:
            _keepers[problem] = Keeper(problem)
        if not _running and _keepers[problem].wants():
            indexing = Indexing(bpy.context, partial(index_places, problem))
            _running.append((_keepers[problem], indexing))


def _attend(keeper: Keeper, indexing: Indexing) -> None:
    """Show how far the running Index is; end it when its library is no longer kept."""
    if not indexing.is_on:  # Another file was loaded: it begins again.
        _running.clear()
    elif keeper.problem not in _keepers:
        _running.clear()
        indexing.abandon(bpy.context)
    elif not indexing.job.done():
        indexing.show(bpy.context)
    else:
        _running.clear()
        keeper.indexed()
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
    """Begin to look; timers run only where there is a window."""
    bpy.app.timers.register(look, first_interval=BETWEEN_LOOKS, persistent=True)


def unregister() -> None:
    """Look no more."""
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    _running.clear()
    while _keepers:
        _keepers.popitem()[1].stop()
