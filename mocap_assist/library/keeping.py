"""Sources that change are indexed again without being asked: a thread looks after them."""

import os
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ..jobs.indexing import IndexProblem
from ..watch import why_busy
from .background import why_indexing
from .places import index_problem

BETWEEN_LOOKS = 15.0  # seconds
Files = frozenset[tuple[str, int, int]]
"""Path, size and time of each."""
State = tuple[IndexProblem, Files]
"""What is to be indexed, and what was there."""


class Keeper:
    """Tells when sources have changed, and are not being written any more."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._look: Future[State] | None = None
        self._seen: State | None = None
        self._indexed: State | None = None

    def wants(self, problem: IndexProblem) -> bool:
        """Tell what the last look has shown, and look again; nobody waits for it.

        Returns
        -------
        bool
            What is there differs from what was indexed, and was the same twice.
        """
        if self._look is not None and not self._look.done():
            return False
        found = self._look.result() if self._look is not None else None
        settled = found is not None and found == self._seen != self._indexed
        if settled:
            self._indexed = found
        self._seen = found
        self._look = self._thread.submit(state_of, problem)
        return settled

    def stop(self) -> None:
        """Look no more."""
        self._thread.shutdown(wait=False, cancel_futures=True)


def state_of(problem: IndexProblem) -> State:
    """Return what lies in the places that are indexed, but for the library itself.

    What cannot be looked at is as if it were not there: Index will say so.
    """
    own = Path(os.path.realpath(problem.library))
    files = (path for place in problem.places for path in _files(place.path))
    # SQLite keeps files of its own beside the library, whose names begin with the library's.
    others = (
        path
        for path in files
        if path.parent != own.parent or not path.name.startswith(own.name)
    )
    return problem, frozenset(seen for path in others if (seen := _seen(path)))


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


_keeper: list[Keeper] = []


def _keep() -> float:
    window = next(iter(bpy.context.window_manager.windows), None)
    if window is not None:
        with bpy.context.temp_override(window=window):
            keep(window.scene)
    return BETWEEN_LOOKS


def keep(scene: bpy.types.Scene) -> None:
    """Press Index, if the scene asks for that and something has changed."""
    library = scene.mocap_assist.library
    if not library.keep_current or why_indexing() or why_busy():
        return
    try:
        problem = index_problem(library.settings().choices)
    except MocapAssistError:  # nothing is listed: whoever presses Index is told
        return
    if not _keeper:
        _keeper.append(Keeper())
    if _keeper[0].wants(problem):
        try:
            bpy.ops.mocap_assist.index_library("INVOKE_DEFAULT", by_itself=True)
        except RuntimeError as refusal:  # A timer that raises is never called again.
            bpy.context.window_manager.mocap_assist_indexing.said = str(refusal).strip()


def register() -> None:
    """Begin to look; timers run only where there is a window."""
    bpy.app.timers.register(_keep, first_interval=BETWEEN_LOOKS, persistent=True)


def unregister() -> None:
    """Look no more."""
    if bpy.app.timers.is_registered(_keep):
        bpy.app.timers.unregister(_keep)
    while _keeper:
        _keeper.pop().stop()
