"""The search that users have, as a method of the benchmark."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solvers.motion import Tracks
from solvers.retrieval import Clip, ClipLibrary, FindSettings, build_clip_library, find_similar

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

TINY = 1e-300


@dataclass(frozen=True)
class Default:
    """`find_similar`, without alignment of what was found."""

    settings: FindSettings = FindSettings(n_aligned=0)

    def prepare(self, clips: Sequence[Tracks]) -> "DefaultLibrary":
        library = build_clip_library([
            Clip(str(number), clip) for number, clip in enumerate(clips)
        ])  # fmt: skip
        return DefaultLibrary(library, len(clips), self.settings)


@dataclass(frozen=True, eq=False)
class DefaultLibrary:
    library: ClipLibrary
    n_clips: int
    settings: FindSettings

    def describe(self, tracks: Tracks) -> Tracks:
        return tracks

    def distances(self, query: Tracks, allowed: Flags) -> Array:
        """Describes the query too: what it takes cannot be told apart."""
        ignored = [str(number) for number in np.flatnonzero(~allowed)]
        found = find_similar(query, self.library, settings=self.settings, ignore=ignored)
        result = np.full(self.n_clips, np.inf)
        for match in found:
            result[int(match.clip)] = -np.log(max(match.score, TINY))
        return result
