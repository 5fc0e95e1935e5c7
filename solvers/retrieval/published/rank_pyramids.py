"""The order of a library's clips by spatial temporal pyramid matching, as published."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from scipy.sparse import csc_array, vstack

from ...progress import Progress, unwatched, within
from ..index import Vocabulary
from ..library import ClipLibrary
from ..postures import ClipPostures
from ..search import Ranking
from .dictionary import PostureDictionary, learn_dictionary
from .pyramid_matching import pyramid_descriptor, pyramid_kernel


@dataclass(frozen=True, eq=False)
class _Pyramids:
    """The clips of a library as pyramids, as long as it has these clips."""

    numbers: tuple[int, ...]
    dictionary: PostureDictionary
    rows: Any
    frames: np.ndarray[Any, np.dtype[np.int32]]


_PYRAMID_CACHE: WeakKeyDictionary[ClipLibrary, _Pyramids] = WeakKeyDictionary()


def rank_pyramids(
    query: ClipPostures,
    library: ClipLibrary,
    ignore: Sequence[int] = (),
    *,
    progress: Progress = unwatched,
) -> Ranking:
    """Rank clips by the temporal sparse representation [ZH14, sections 3.3 and 3.4].

    One dictionary of whole postures is learned of all clips, which takes minutes for hundreds,
    and kept as long as the library does not change. Clips are as the library has them, at
    20 Hz; joints that were not tracked are filled in.

    Raises
    ------
    InvalidMotionError
        The library has fewer postures than the dictionary has atoms.
    """
    vocabulary = library.vocabulary
    assert vocabulary is not None
    numbers = tuple(library.numbered())
    kept = _PYRAMID_CACHE.get(library)
    if kept is None or kept.numbers != numbers:
        kept = _build_pyramids(library, numbers, vocabulary, within(progress, 0.0, 0.9))
        _PYRAMID_CACHE[library] = kept
    asked = pyramid_descriptor(_fill_gaps(query, vocabulary), kept.dictionary)
    alike = pyramid_kernel(asked, kept.rows)[0]
    most = max(float(asked.sum()), np.finfo(float).tiny)
    left = np.flatnonzero(~np.isin(kept.numbers, list(ignore)))
    order = left[np.argsort(-alike[left], kind="stable")]
    distances = np.maximum(1.0 - alike / most, 0.0).astype(np.float32)
    return Ranking(np.array(kept.numbers)[order], kept.frames[order], distances[order])


def _build_pyramids(
    library: ClipLibrary, numbers: tuple[int, ...], vocabulary: Vocabulary, progress: Progress
) -> _Pyramids:
    clips = [_fill_gaps(library.postures(number), vocabulary) for number in numbers]
    dictionary = learn_dictionary(clips, progress=within(progress, 0.0, 0.7))
    rows = []
    for place, clip in enumerate(clips):
        progress(0.7 + 0.3 * place / len(clips), "Pooling")
        rows.append(pyramid_descriptor(clip, dictionary))
    ends = np.array([[0, clip.n_frames] for clip in clips], dtype=np.int32)
    return _Pyramids(numbers, dictionary, csc_array(vstack(rows)), ends)


def _fill_gaps(clip: ClipPostures, vocabulary: Vocabulary) -> ClipPostures:
    return vocabulary.usual.completed(clip)
