"""The library for an actor in front of a camera: show, page, choose, search by performing.

Each function returns a sentence to show.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple, Self

import bpy
import numpy as np
from bpy.app import timers

from ...solvers.errors import InvalidMotionError, MocapAssistError
from ...solvers.motion import JointRecording, Tracks
from ...solvers.motion.humanoid import POSTURE_JOINTS
from ..blender.redrawing import redraw
from ..jobs.job import Job, run
from ..library.solve_prior import Own
from ..library.sources import library_path
from ..runtime.solver_operator import in_background
from ..scene.units import unit_of
from . import searches
from .scene_finding import fill_list
from .solve_finding import (
    BROWSED_HZ,
    MAX_MATCHES,
    Finding,
    FindProblem,
    find_clips,
    list_clips,
)

POLL_INTERVAL_S = 0.2
"""Seconds between two looks at a performance. It bounds the delay of its end."""
PERFORMED = "your performance"
THE_LIBRARY = "the library"
NO_LIBRARY = "There is no library yet. Add folders, then press Build Library."

_pending: list["_PendingList"] = []  # the newest one, until it has ended
_news: list[str] = []


def show_library(context: bpy.types.Context) -> str:
    """Open the sidebar of every 3D View of the window on the library, with the ghost.

    What was searched for last is listed, or else the clips of the library.
    """
    for area in context.window.screen.areas if context.window else ():
        if area.type == "VIEW_3D" and not area.spaces.active.show_region_ui:
            area.spaces.active.show_region_ui = True  # set again, it would fade in again
    bpy.context.window_manager.mocap_assist_ghost = True
    redraw(bpy.context)
    if bpy.context.window_manager.mocap_assist_matches.rows:
        return chosen_sentence()
    return show_all(context)


def show_all(context: bpy.types.Context, first: int = 0, row: int = 0) -> str:
    """List clips of the library from an index on, and choose one; row -1 is the last."""
    library = _library()
    if library is None:
        return NO_LIBRARY
    solve = partial(list_clips, str(library), first)
    listing = _Listing.of(THE_LIBRARY, BROWSED_HZ, row)
    return _list_later(solve, listing, "Reading the library...")


def show_next_match(context: bpy.types.Context, step: int) -> str:
    """Choose the next or previous match; the first follows the last.

    In a library with more clips than are listed, the next ones follow. While they are read,
    further calls count from the clip that will be chosen.
    """
    if _pending and _pending[0].is_awaited and _pending[0].listing.query == THE_LIBRARY:
        _pending[0].waves += step
        return ""
    listed, search = (
        bpy.context.window_manager.mocap_assist_matches,
        searches.listed_search(context),
    )
    if not listed.rows:
        return chosen_sentence()
    index = listed.active + step
    if search is not None and not search.is_ranked and not 0 <= index < len(listed.rows):
        finding = search.finding
        if finding.n_clips > len(listed.rows):
            return show_all(context, _next_first(finding, step), -1 if step < 0 else 0)
    listed.active = index % len(listed.rows)
    redraw(bpy.context)
    return chosen_sentence()


def search_with_shown(context: bpy.types.Context) -> str:
    """Search with the clip that is shown."""
    try:
        _, found = searches.chosen_match(bpy.context)
    except InvalidMotionError as error:
        return str(error)
    postures = found.postures.astype(np.float64)
    origin, query = found.entry.origin, Tracks(POSTURE_JOINTS, postures, found.rate)
    own = ((origin.path, origin.item),) if origin is not None else ()
    return search_with(context, query, found.entry.name, own)


def search_with(
    context: bpy.types.Context,
    query: JointRecording | Tracks,
    name: str = PERFORMED,
    own: Own = (),
) -> str:
    """Search with a recording in the background, and fill the list at the end.

    Clips from the files and actions of the query itself, `own`, are not listed.
    """
    library = _library()
    if library is None:
        return NO_LIBRARY
    settings = bpy.context.scene.mocap_assist.find.settings().finding
    solve = partial(find_clips, FindProblem(query, str(library), settings, own))
    n_frames = len(query.positions) if isinstance(query, Tracks) else query.n_frames
    listing = _Listing.of(name, query.frame_rate)
    return _list_later(solve, listing, f"Searching with {n_frames} frames...")


def new_message() -> str:
    """Return the sentence about a list that was filled since the last call, or why it failed.

    Empty without one.
    """
    return _news.pop() if _news else ""


def chosen_sentence() -> str:
    """Return a sentence that names the chosen match."""
    listed = bpy.context.window_manager.mocap_assist_matches
    if not listed.rows:
        return "No search yet."
    index = min(listed.active, len(listed.rows) - 1)
    row, search = listed.rows[index], searches.listed_search(bpy.context)
    if search is not None and search.finding.first is not None:
        return f"{search.finding.first + index + 1} of {search.finding.n_clips}: {row.name}."
    return f"{index + 1} of {len(listed.rows)}: {row.name} ({row.score:.0%})."


def _library() -> Path | None:
    """Return the library of the scene; None if it was not built."""
    library = library_path(bpy.context.scene.mocap_assist.library.settings().choices)
    return library if library.is_file() else None


def _next_first(finding: Finding, step: int) -> int:
    """Return the index of the first clip to list after, or before, the listed ones."""
    assert finding.first is not None
    last_page = (finding.n_clips - 1) // MAX_MATCHES
    page_number = finding.first // MAX_MATCHES + step
    return page_number % (last_page + 1) * MAX_MATCHES


def _list_later(solve: Callable[..., Finding], listing: "_Listing", waiting: str) -> str:
    """List the result of a solve after its end; return a sentence for the meantime.

    A solve that has not ended yet is cancelled.
    """
    if in_background():
        return listing.fill(run(solve))
    if _pending:
        older = _pending.pop().job
        older.cancel()
        older.tidy_up()
    _news.clear()
    try:
        job: Job[Finding] = Job(solve)
    except MocapAssistError as error:
        return str(error)
    pending = _PendingList(job, listing, searches.newest_search_number())
    _pending.append(pending)
    timers.register(partial(_poll, pending), first_interval=POLL_INTERVAL_S)
    return waiting


class _Listing(NamedTuple):
    """The scene and query that a list of clips belongs to."""

    query: str
    grid: tuple[float, float]
    meters: float
    row: int
    """Index of the clip to choose; -1: the last."""

    @classmethod
    def of(cls, query: str, frame_rate: float, row: int = 0) -> Self:
        """Return the list for a query that begins at the current frame."""
        scene = bpy.context.scene
        step = scene.render.fps / scene.render.fps_base / frame_rate
        return cls(query, (float(scene.frame_current), step), unit_of(scene), row)

    def fill(self, finding: Finding, waves: int = 0) -> str:
        """List the clips; return a sentence that names the chosen one."""
        fill_list(
            bpy.context, searches.store_search(self.query, self.grid, self.meters, finding)
        )
        listed = bpy.context.window_manager.mocap_assist_matches
        listed.active = self.row % max(len(finding.found), 1)
        message = chosen_sentence()
        for _ in range(abs(waves)):  # beyond the page they count for the next one
            message = show_next_match(bpy.context, 1 if waves > 0 else -1) or message
        return message


@dataclass(eq=False)
class _PendingList:
    """A list that a job makes in the background."""

    job: Job[Finding]
    listing: _Listing
    newest: int
    """Number of the newest search when the job began."""
    waves: int = 0
    """Clips to go on from the one that would be chosen."""

    @property
    def is_awaited(self) -> bool:
        """Whether no other search was listed since, such as by Find Similar."""
        return searches.newest_search_number() == self.newest


def _poll(pending: _PendingList) -> float | None:
    """Fill the list once the job has ended; otherwise return the seconds to the next call."""
    if pending not in _pending:  # it was cancelled
        return None
    if not pending.job.done():
        return POLL_INTERVAL_S
    _pending.remove(pending)
    try:
        finding = pending.job.result()
        if pending.is_awaited:
            _news[:] = [pending.listing.fill(finding, pending.waves)]
        else:
            _news[:] = [chosen_sentence()]
    except MocapAssistError as error:
        _news[:] = [str(error)]
        bpy.context.window_manager.mocap_assist_indexing.report = str(error)
    redraw(bpy.context)
    return None
