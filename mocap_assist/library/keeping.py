"""Sources that change are indexed again without being asked: a thread looks after them."""

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ..jobs.indexing import IndexProblem
from .background import why_indexing
from .places import index_problem

BETWEEN_LOOKS = 15.0  # seconds
State = frozenset[tuple[str, int, int]]
"""Path, size and time of each file."""


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
    """Return what lies in the places that are indexed, but for the library itself."""
    own = str(Path(problem.library).resolve())
    return frozenset(
        (str(path), found.st_size, found.st_mtime_ns)
        for place in problem.places
        for path in _files(Path(place.path))
        if not str(path.resolve()).startswith(own) and (found := path.stat())
    )


def _files(place: Path) -> Iterator[Path]:
    found = place.rglob("*") if place.is_dir() else [place]
    return (path for path in found if path.is_file())


_keeper: list[Keeper] = []


def _keep() -> float:
    window = next(iter(bpy.context.window_manager.windows), None)
    if window is not None:
        with bpy.context.temp_override(window=window):
            keep(window.scene)
    return BETWEEN_LOOKS


def keep(scene: bpy.types.Scene) -> None:
    """Press Index, if the scene asks for that and something has changed."""
    choices = scene.mocap_assist.library.settings().choices
    if not choices.keep_current or why_indexing():
        return
    try:
        problem = index_problem(choices)
    except MocapAssistError:  # nothing is listed: whoever presses Index is told
        return
    if not _keeper:
        _keeper.append(Keeper())
    if _keeper[0].wants(problem):
        bpy.ops.mocap_assist.index_library("INVOKE_DEFAULT")


def register() -> None:
    """Begin to look; timers run only where there is a window."""
    bpy.app.timers.register(_keep, first_interval=BETWEEN_LOOKS, persistent=True)


def unregister() -> None:
    """Look no more."""
    bpy.app.timers.unregister(_keep)
    while _keeper:
        _keeper.pop().stop()
