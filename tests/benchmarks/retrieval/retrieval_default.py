"""The search that users have, as a method of the benchmark: `find_similar` in two steps."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array, Flags
from solvers.motion import Tracks
from solvers.retrieval import Clip, ClipLibrary, FindSettings, build_clip_library
from solvers.retrieval.index.clip_segments import CLIP_RATE_HZ
from solvers.retrieval.postures.clip_postures import clip_postures
from solvers.retrieval.search.describe_query import DescribedQuery, describe_query
from solvers.retrieval.search.rank_clips import rank_clips


@dataclass(frozen=True)
class Default:
    """`find_similar`, without alignment of what was found."""

    settings: FindSettings = FindSettings()

    def prepare(self, clips: Sequence[Tracks]) -> "DefaultLibrary":
        library = build_clip_library([
            Clip(str(number), clip) for number, clip in enumerate(clips)
        ])  # fmt: skip
        names = {number: int(entry.name) for number, entry in library.numbered().items()}
        indices = np.zeros(max(names) + 1, dtype=np.intp)
        indices[list(names)] = list(names.values())
        return DefaultLibrary(library, indices, self.settings)


class QueryWithSettings(NamedTuple):
    """A query and the settings of its search: those for a sensor, if one recorded it."""

    described: DescribedQuery
    settings: FindSettings


@dataclass(frozen=True, eq=False)
class DefaultLibrary:
    library: ClipLibrary
    indices: NDArray[np.intp]
    """Which clip each number of the library is."""
    settings: FindSettings

    def describe(self, tracks: Tracks) -> QueryWithSettings:
        vocabulary = self.library.vocabulary
        assert vocabulary is not None
        postures = clip_postures(tracks, CLIP_RATE_HZ)
        settings = self.settings if tracks.confidence is None else self.settings.for_sensor()
        return QueryWithSettings(describe_query(postures, vocabulary, settings), settings)

    def distances(self, query: QueryWithSettings, allowed: Flags) -> Array:
        ignored = self.library.numbers_of(map(str, np.flatnonzero(~allowed)))
        described, index = query.described, self.library.search_index
        ranking = rank_clips(
            described.segments, described.weights, index, query.settings, ignored
        )
        result = np.full(len(allowed), np.inf)
        result[self.indices[ranking.clips]] = ranking.distances
        return result
