"""The search that users have, as a method of the benchmark: `find_similar` in two steps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solvers.motion import Tracks
from solvers.retrieval import Clip, ClipLibrary, FindSettings, build_clip_library
from solvers.retrieval.body_parts import part_coverage
from solvers.retrieval.clip_postures import clip_postures
from solvers.retrieval.rank_clips import rank_clips
from solvers.retrieval.spans import RATE, Spans, describe

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Default:
    """`find_similar`, without alignment of what was found."""

    settings: FindSettings = FindSettings()

    def prepare(self, clips: Sequence[Tracks]) -> "DefaultLibrary":
        library = build_clip_library([
            Clip(str(number), clip) for number, clip in enumerate(clips)
        ])  # fmt: skip
        names = {number: int(entry.name) for number, entry in library.numbered().items()}
        places = np.zeros(max(names) + 1, dtype=np.intp)
        places[list(names)] = list(names.values())
        return DefaultLibrary(library, places, self.settings)


@dataclass(frozen=True, eq=False)
class DefaultLibrary:
    library: ClipLibrary
    places: NDArray[np.intp]
    """Which clip each number of the library is."""
    settings: FindSettings

    def describe(self, tracks: Tracks) -> tuple[Spans, Array]:
        postures = clip_postures(tracks, RATE)
        vocabulary = self.library.vocabulary
        assert vocabulary is not None
        features = vocabulary.features(postures)
        whole = np.array([[0, len(features)]], dtype=np.int32)
        seen = np.isfinite(postures.positions).all(axis=-1)
        activity = vocabulary.activity(features)
        weights = self.settings.part_weights(part_coverage(seen), activity)
        return describe(features, whole, vocabulary), weights

    def distances(self, query: tuple[Spans, Array], allowed: Flags) -> Array:
        ignored = self.library.numbers_of(map(str, np.flatnonzero(~allowed)))
        ranking = rank_clips(*query, self.library.search_index, self.settings, ignored)
        result = np.full(len(allowed), np.inf)
        result[self.places[ranking.clips]] = ranking.distances
        return result
