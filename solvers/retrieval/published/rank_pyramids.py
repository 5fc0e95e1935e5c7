"""Rank the clips of a library by spatial temporal pyramid matching, as published."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import scipy

from ...progress import Progress, unwatched, within
from ..index import Vocabulary
from ..library import ClipLibrary
from ..postures import ClipPostures
from ..search import Ranking
from .dictionary import PostureDictionary, learn_dictionary
from .pyramid_matching import pyramid_descriptor, pyramid_kernel


@dataclass(frozen=True, eq=False)
class _Pyramids:
    """Pyramids of the clips of a library, valid while the clips are the same."""

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

    One dictionary of complete postures is learned from all clips, which takes minutes for
    hundreds of clips, and is cached until the library changes. Clips are at 20 Hz, as stored;
    missing joints are filled.

    Raises
    ------
    InvalidMotionError
        The library has fewer postures than the dictionary has atoms.
    """
    vocabulary = library.vocabulary
    assert vocabulary is not None
    numbers = tuple(library.numbered())
    pyramids = _PYRAMID_CACHE.get(library)
    if pyramids is None or pyramids.numbers != numbers:
        pyramids = _build_pyramids(library, numbers, vocabulary, within(progress, 0.0, 0.9))
        _PYRAMID_CACHE[library] = pyramids
    descriptor = pyramid_descriptor(_fill_gaps(query, vocabulary), pyramids.dictionary)
    similarities = pyramid_kernel(descriptor, pyramids.rows)[0]
    max_similarity = max(float(descriptor.sum()), np.finfo(float).tiny)
    candidates = np.flatnonzero(~np.isin(pyramids.numbers, list(ignore)))
    order = candidates[np.argsort(-similarities[candidates], kind="stable")]
    distances = np.maximum(1.0 - similarities / max_similarity, 0.0).astype(np.float32)
    return Ranking(np.array(pyramids.numbers)[order], pyramids.frames[order], distances[order])


def _build_pyramids(
    library: ClipLibrary, numbers: tuple[int, ...], vocabulary: Vocabulary, progress: Progress
) -> _Pyramids:
    clips = [_fill_gaps(library.postures(number), vocabulary) for number in numbers]
    dictionary = learn_dictionary(clips, progress=within(progress, 0.0, 0.7))
    rows = []
    for index, clip in enumerate(clips):
        progress(0.7 + 0.3 * index / len(clips), "Pooling")
        rows.append(pyramid_descriptor(clip, dictionary))
    ends = np.array([[0, clip.n_frames] for clip in clips], dtype=np.int32)
    return _Pyramids(
        numbers, dictionary, scipy.sparse.csc_array(scipy.sparse.vstack(rows)), ends
    )


def _fill_gaps(clip: ClipPostures, vocabulary: Vocabulary) -> ClipPostures:
    return vocabulary.posture_distribution.fill_gaps(clip)
