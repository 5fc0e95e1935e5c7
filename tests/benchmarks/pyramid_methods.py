"""Pyramid matching as a method of the benchmark: as published, and as settings say."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import vstack

from solvers.motion import Tracks
from solvers.retrieval.clip_postures import clip_postures
from solvers.retrieval.dictionary import (
    DictionarySettings,
    PostureDictionary,
    learn_dictionary,
)
from solvers.retrieval.pyramid_matching import (
    PyramidSettings,
    pyramid_descriptor,
    pyramid_kernel,
)

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Pyramids:
    """Spatial temporal pyramid matching; `cosine` divides by both clips' own size."""

    dictionary: DictionarySettings = DictionarySettings()
    pyramid: PyramidSettings = PyramidSettings()
    frame_rate: float = 120.0
    cosine: bool = False

    def prepare(self, clips: Sequence[Tracks]) -> "PyramidLibrary":
        postures = [clip_postures(clip, self.frame_rate) for clip in clips]
        dictionary = learn_dictionary(postures, self.dictionary)
        rows = [pyramid_descriptor(each, dictionary, self.pyramid) for each in postures]
        sizes = np.array([row.sum() for row in rows])
        return PyramidLibrary(self, dictionary, vstack(rows).tocsc(), sizes)


@dataclass(frozen=True, eq=False)
class PyramidLibrary:
    method: Pyramids
    dictionary: PostureDictionary
    rows: Any
    sizes: Array

    def describe(self, tracks: Tracks) -> Any:
        postures = clip_postures(tracks, self.method.frame_rate)
        return pyramid_descriptor(postures, self.dictionary, self.method.pyramid)

    def distances(self, query: Any, allowed: Flags) -> Array:
        kernel = pyramid_kernel(query, self.rows)[0]
        return -kernel / np.sqrt(self.sizes * query.sum()) if self.method.cosine else -kernel
