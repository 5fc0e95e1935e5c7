"""The library for an actor in front of a camera: show, page, and search by performing.

Each function returns a sentence to show.
"""

from functools import partial

import bpy
from bpy.app import timers

from ...solvers.errors import MocapAssistError
from ...solvers.motion import JointRecording
from ..drawing.view_drawing import redraw
from ..jobs.job import Job, run
from ..library.sources import library_path
from ..runtime.solver_operator import in_background
from ..scene.units import unit_of
from . import searches
from .finding import fill_list
from .solve_finding import Finding, FindProblem, find_clips

POLL_INTERVAL_S = 0.2  # seconds
PERFORMED = "your performance"


def show_library(context: bpy.types.Context) -> str:
    """Open the sidebar of every 3D View of the window on the library, with the ghost."""
    for area in context.window.screen.areas if context.window else ():
        if area.type == "VIEW_3D":
            area.spaces.active.show_region_ui = True
    bpy.context.window_manager.mocap_assist_ghost = True
    redraw(bpy.context)
    return chosen_sentence()


def page(context: bpy.types.Context, step: int) -> str:
    """Choose the next match, or the one before; from the last one on to the first."""
    listed = bpy.context.window_manager.mocap_assist_matches
    if listed.rows:
        listed.active = (listed.active + step) % len(listed.rows)
        redraw(bpy.context)
    return chosen_sentence()


def search_with(context: bpy.types.Context, query: JointRecording) -> str:
    """Search with a recording in the background, and fill the list at the end."""
    scene = bpy.context.scene
    library = library_path(scene.mocap_assist.library.settings().choices)
    if not library.is_file():
        return "There is no library yet. Add folders, then press Build Library."
    settings = scene.mocap_assist.find.settings().finding
    solve = partial(find_clips, FindProblem(query, str(library), settings))
    start, meters = float(scene.frame_current), unit_of(scene)
    step = scene.render.fps / scene.render.fps_base / query.frame_rate
    if in_background():
        return _list_matches(run(solve), (start, step), meters)
    job: Job[Finding] = Job(solve)
    timers.register(
        partial(_poll_search, job, (start, step), meters), first_interval=POLL_INTERVAL_S
    )
    return f"Searching with {query.n_frames} frames..."


def chosen_sentence() -> str:
    """Say which match is chosen."""
    listed = bpy.context.window_manager.mocap_assist_matches
    if not listed.rows:
        return "No search yet."
    index = min(listed.active, len(listed.rows) - 1)
    row = listed.rows[index]
    return f"{index + 1} of {len(listed.rows)}: {row.name} ({row.score:.0%})."


def _poll_search(job: Job[Finding], grid: tuple[float, float], meters: float) -> float | None:
    """Fill the list once the job has ended; otherwise return the seconds to the next call."""
    if not job.done():
        return POLL_INTERVAL_S
    try:
        _list_matches(job.result(), grid, meters)
    except MocapAssistError as error:
        bpy.context.window_manager.mocap_assist_indexing.report = str(error)
    redraw(bpy.context)
    return None


def _list_matches(finding: Finding, grid: tuple[float, float], meters: float) -> str:
    fill_list(bpy.context, searches.keep(PERFORMED, grid, meters, finding))
    return chosen_sentence()
