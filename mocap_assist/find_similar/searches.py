"""Cache of the last searches while Blender runs; they are too large for a .blend file."""

from typing import NamedTuple

import bpy

from ...solvers.errors import InvalidMotionError
from .solve_finding import Finding, Found

MAX_CACHED = 8


class Search(NamedTuple):
    """A query, and the matches that were found."""

    number: int
    query: str
    """Name of the action."""
    start: float
    """Scene frame of the query's first frame."""
    step: float
    """Scene frames from one of its frames to the next."""
    meters: float
    """Length of one of the scene's units."""
    finding: Finding

    @property
    def is_ranked(self) -> bool:
        """Whether its clips were searched for; otherwise they are those of the library."""
        return self.finding.first is None

    def scene_frame(self, query_frame: float) -> float:
        """Return the scene frame of a frame of the query."""
        return self.start + self.step * query_frame


_cache: dict[int, Search] = {}
_last: list[int] = [0]


def store_search(
    query: str, grid: tuple[float, float], meters: float, finding: Finding
) -> Search:
    """Store a search; old ones are removed."""
    _last[0] += 1
    search = Search(_last[0], query, *grid, meters, finding)
    _cache[search.number] = search
    browsed = [number for number, each in _cache.items() if not each.is_ranked]
    for number in browsed[:-1]:  # pages of complete clips are large
        del _cache[number]
    while len(_cache) > MAX_CACHED:
        del _cache[next(iter(_cache))]
    return search


def newest_search_number() -> int:
    """Return the number of the newest search; 0 before the first."""
    return _last[0]


def listed_search(context: bpy.types.Context) -> Search | None:
    """Return the search whose matches are listed, if it is still known."""
    return _cache.get(context.window_manager.mocap_assist_matches.search)


def chosen_match(context: bpy.types.Context) -> tuple[Search, Found]:
    """Return the match that is chosen in the list, and the search that has found it.

    Raises InvalidMotionError where there is none.
    """
    search = listed_search(context)
    index = context.window_manager.mocap_assist_matches.active
    if search is None or not 0 <= index < len(search.finding.found):
        raise InvalidMotionError("No clip is chosen. Press Find Similar, and click on one.")
    return search, search.finding.found[index]


def ranked_search(context: bpy.types.Context) -> Search:
    """Return the search whose matches are listed, best first.

    Raises InvalidMotionError where none is chosen, or where the clips were not searched for.
    """
    search, _ = chosen_match(context)
    if not search.is_ranked:
        raise InvalidMotionError("These clips were not searched for. Press Find Similar first.")
    return search


def why_none(context: bpy.types.Context) -> str:
    """Return why no match is chosen, or an empty text."""
    try:
        chosen_match(context)
    except InvalidMotionError as error:
        return str(error)
    return ""
