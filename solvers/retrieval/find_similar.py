"""Find the clips of a library that are like a recording, and where in them it is."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording, Tracks
from ..progress import Progress, unwatched, within
from .index import RATE, ClipEntry, Match, Vocabulary
from .library import ClipLibrary
from .postures import ClipPostures, Recording, clip_postures
from .published import rank_pyramids
from .search import (
    DEFAULT_FIND_SETTINGS,
    DescribedQuery,
    FindMethod,
    FindSettings,
    Ranking,
    align_frames,
    describe_query,
    rank_clips,
)

Array = NDArray[np.float64]
Frames = NDArray[np.intp]

SCORE_DECAY = 2.0
"""Of the score over the distance: what has nothing in common is about 1.5 apart."""
ROUNDING_FRAMES = 1e-6
MARGIN_FRACTION = 0.5
"""Part of a span's length by which what is found may begin before it and end after."""


def find_similar(
    query: Recording,
    library: ClipLibrary,
    *,
    settings: FindSettings = DEFAULT_FIND_SETTINGS,
    ignore: Collection[str] = (),
    progress: Progress = unwatched,
) -> tuple[Match, ...]:
    """Rank the clips of a library by how like the query they are.

    Histograms of words in an inverted index find candidates [1]_, dynamic time warping compares
    how those go on in time, and each is judged by those that are like it as well, as in [2]_:
    another actor's kick is like kicks that are more like this one.

    Parameters
    ----------
    query : Motion, Tracks or JointRecording
        In what a sensor saw (points with confidences are) the mean posture counts less: it
        puts joints where others do not. Gaps are filled in as is probable; a part of the body
        of which little is known hardly counts.
    library : ClipLibrary
    settings : FindSettings
    ignore : names of clips, optional
        That are not told, as the query itself.
    progress : Progress

    Returns
    -------
    tuple of Match
        Best first. Long clips are matched in part where that fits better; frames are those
        of the aligned path for the best matches and those of the indexed span for others.

    Raises
    ------
    InvalidMotionError
        The query shows no body, or no part of it that is to be compared was tracked.

    References
    ----------
    .. [1] Sivic, Zisserman (2003). Video Google. ICCV. doi:10.1109/ICCV.2003.1238663
    .. [2] Arandjelovic, Zisserman (2012). Three things everyone should know to improve object
       retrieval. CVPR. doi:10.1109/CVPR.2012.6248018
    """
    progress(0.0, "Searching")
    postures = clip_postures(query, RATE)
    vocabulary, entries = library.vocabulary, library.numbered()
    if vocabulary is None or not entries:
        return ()
    tracks = query.tracks if isinstance(query, JointRecording) else query
    if tracks is not query or (isinstance(tracks, Tracks) and tracks.confidence is not None):
        settings = settings.for_sensor()
    asked = describe_query(postures, vocabulary, settings)
    left_out = library.numbers_of(ignore)
    if settings.method is FindMethod.PUBLISHED:
        ranking = rank_pyramids(
            postures, library, left_out, progress=within(progress, 0.0, 0.3)
        )
    else:
        ranking = rank_clips(
            asked.spans, asked.weights, library.search_index, settings, left_out
        )
    told = settings.n_matches or len(ranking.clips)
    matches = _build_matches(ranking, told, entries)
    alignment = _Alignment(asked, vocabulary, tracks.n_frames, tracks.frame_rate)
    aligning = within(progress, 0.3, 1.0)
    for place in range(min(settings.n_aligned, len(matches))):
        aligning(place / settings.n_aligned, "Aligning")
        matches[place] = alignment.match(ranking, place, matches[place], library)
    progress(1.0)
    return tuple(matches)


def _build_matches(
    ranking: Ranking, most: int, entries: Mapping[int, ClipEntry]
) -> list[Match]:
    """Return matches whose frames are those of the spans."""
    clips = [entries[number] for number in ranking.clips[:most].tolist()]
    lengths = np.array([clip.n_frames for clip in clips], dtype=np.intp)
    rates = np.array([clip.frame_rate for clip in clips])
    spans = ranking.frames[:most]
    starts = _clip_frames(spans[:, 0], lengths, rates).tolist()
    stops = (_clip_frames(spans[:, 1] - 1, lengths, rates) + 1).tolist()
    scores = np.exp(-SCORE_DECAY * np.maximum(ranking.distances[:most].astype(float), 0.0))
    return [
        Match(clip.name, range(start, stop), score)
        for clip, start, stop, score in zip(clips, starts, stops, scores.tolist(), strict=True)
    ]


def _clip_frames(
    frames: NDArray[np.integer[Any]], n_frames: int | Frames, frame_rate: float | Array
) -> Frames:
    """Return a recording's own frames at frames of the index; its last is that of the index."""
    last = np.asarray((n_frames - 1) * RATE / frame_rate + ROUNDING_FRAMES).astype(np.intp)
    own = np.round(frames / RATE * frame_rate).astype(np.intp)
    return np.where(frames >= last, n_frames - 1, np.minimum(own, n_frames - 1))


class _Alignment:
    """Aligns a query with clips."""

    def __init__(
        self,
        asked: DescribedQuery,
        vocabulary: Vocabulary,
        n_frames: int,
        frame_rate: float,
    ) -> None:
        self._weights = np.sqrt(asked.weights)[:, None]
        features = asked.features * self._weights
        self._features = features.reshape(len(features), -1)
        self._vocabulary = vocabulary
        self._n_frames, self._frame_rate = n_frames, frame_rate

    def match(self, ranking: Ranking, place: int, match: Match, library: ClipLibrary) -> Match:
        """Return a match whose frames are those that the query is aligned with."""
        number = int(ranking.clips[place])
        start, stop = ranking.frames[place].tolist()
        clip, entry = library.postures(number, stop), library.numbered()[number]
        around = round(MARGIN_FRACTION * (stop - start))
        first = max(start - around, 0)
        near = slice(first, stop + around)
        part = ClipPostures(clip.positions[near], clip.course[near], clip.frame_rate)
        features = self._vocabulary.features(part)
        told = (features * self._weights).reshape(len(features), -1)
        path = align_frames(self._features, told)
        theirs = _clip_frames(path[:, 1] + first, entry.n_frames, entry.frame_rate)
        ours = _clip_frames(path[:, 0], self._n_frames, self._frame_rate)
        return replace(
            match,
            frames=range(int(theirs[0]), int(theirs[-1]) + 1),
            alignment=np.column_stack([ours, theirs]),
        )
