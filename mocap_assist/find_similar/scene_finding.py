"""Read the query of the button Find Similar from the scene, and fill the list of matches."""

from functools import partial
from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from ...solvers.motion import Motion, Tracks
from ...solvers.retrieval import FindSettings
from ..actions.armature_read import read_take
from ..actions.frames import FrameRange, Grid
from ..actions.markers.take import read_markers
from ..blender.time_slices import Sliced, Steps
from ..library.button_settings import FindBundle
from ..library.library_prior import own_origins
from ..library.sources import library_path
from ..runtime.selection import (
    Bones,
    chosen_bones,
    first_animated_object,
    played_source,
    why_not_read,
)
from ..runtime.subject import Subject, check_unchanged
from ..scene.played_time import played_time
from ..scene.units import unit_of
from . import searches
from .chosen_parts import parts_of_bones
from .match_grid import count_good
from .solve_finding import Finding, FindProblem, find_clips


class Query(NamedTuple):
    """Motion or markers to search for, on a grid of frames."""

    recording: Motion | Tracks
    grid: Grid


def why_not_find(context: bpy.types.Context) -> str:
    """Return why no search can start, or an empty text."""
    if reason := why_not_read(context):
        return reason
    choices = context.scene.mocap_assist.library.settings().choices
    # A panel that is drawn does not look at a path that the .blend file names.
    missing = not choices.library_file and not library_path(choices).is_file()
    return "There is no library yet. Add folders, then press Build Library." if missing else ""


@Sliced
def read_query(
    scene: bpy.types.Scene, subject: bpy.types.Object, choice: FrameRange
) -> Steps[Query]:
    """Read what the armature, or the markers, play within a range of frames."""
    if subject.type == "ARMATURE":
        take = yield from read_take.steps(subject, scene, choice, played_source(subject))
        return Query(take.parts[0].motion, take.grid)
    markers = yield from read_markers.steps(subject, scene, choice)
    return Query(markers.tracks, markers.grid)


@Sliced
def read_finding(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: FindBundle
) -> "Steps[partial[Finding]]":
    """Read the query; return the picklable solve."""
    problem, _ = yield from _problem(Subject.of(scene, subject), settings)
    return partial(find_clips, problem)


@Sliced
def list_found(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    settings: FindBundle,
    finding: Finding,
    solved_digest: str | None = None,
) -> Steps[str]:
    """List the matches; return a sentence about them."""
    here = Subject.of(scene, subject)
    problem, query = yield from _problem(here, settings)
    scene, subject = here.find()
    yield from check_unchanged.steps(subject, solved_digest, problem)
    scene, subject = here.find()
    time = played_time(first_animated_object(subject))
    grid = time.scene_frame(query.grid.frames[0]), time.scale * query.grid.step
    name = played_source(subject)[0].name
    fill_list(bpy.context, searches.store_search(name, grid, unit_of(scene), finding))
    n_found = len(finding.found)
    if not n_found:
        return f"No clip of the library ({finding.n_clips} clips) is similar to {name}."
    best = finding.found[0]
    if not count_good([best.match.score]):
        return (
            f"No good match for {name} in {finding.n_clips} clips. Best: {best.entry.name}"
            f" ({best.match.score:.0%})."
        )
    return (
        f"Found {n_found} of {finding.n_clips} clips. Most similar to {name}: {best.entry.name}"
        f" ({best.match.score:.0%})."
    )


def fill_list(context: bpy.types.Context, search: searches.Search) -> None:
    """Show the matches in the sidebar."""
    listed = context.window_manager.mocap_assist_matches
    listed.rows.clear()
    for found in search.finding.found:
        row = listed.rows.add()
        row.name = found.entry.name
        row.score = found.match.score
        row.start, row.stop = found.match.frames.start + 1, found.match.frames.stop
        row.tags = ", ".join(found.entry.tags)
    listed.search, listed.query, listed.active = search.number, search.query, 0


def _problem(here: Subject, settings: FindBundle) -> Steps[tuple[FindProblem, Query]]:
    query = yield from read_query.steps(*here.find(), settings.choices.frame_range)
    scene, subject = here.find()
    library = library_path(scene.mocap_assist.library.settings().choices)
    wanted = _parts(subject, query, settings)
    return FindProblem(query.recording, str(library), wanted, own_origins(subject)), query


def _parts(subject: bpy.types.Object, query: Query, settings: FindBundle) -> FindSettings:
    if settings.choices.bones is Bones.ALL:
        return settings.finding
    if not isinstance(query.recording, Motion):
        raise InvalidMotionError(
            "Markers do not belong to body parts. Choose body parts instead."
        )
    bones = chosen_bones(subject, Bones.SELECTED)
    return parts_of_bones(query.recording.skeleton, bones, settings.finding)
