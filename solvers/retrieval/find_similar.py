"""Find the clips of a library that are similar to a recording, and the matching frames."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, Integers
from ..motion import JointRecording, Tracks
from ..progress import Progress, unwatched, within
from .index import CLIP_RATE_HZ, ClipEntry, Match, Vocabulary
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

SCORE_DECAY = 2.0
"""Factor of the distance in the exponential decay of the score; unrelated clips have a distance
of about 1.5. Chosen by hand; `make sensitivity` varies it."""
ROUNDING_FRAMES = 1e-6
"""Tolerance of a frame number. It absorbs rounding."""
MARGIN_FRACTION = 0.5
"""Margin of the alignment on both sides of a segment, as a fraction of its length. It guards an
action slower than the query, longer than the segment found: at 0.25 its end is cut off."""


def find_similar(
    query: Recording,
    library: ClipLibrary,
    *,
    settings: FindSettings = DEFAULT_FIND_SETTINGS,
    ignore: Collection[str] = (),
    progress: Progress = unwatched,
) -> tuple[Match, ...]:
    """Rank the clips of a library by similarity to the query.

    An inverted index of codeword histograms finds candidates [1]_. Dynamic time warping
    compares them over time. Re-ranking averages the distance of each candidate with those of
    its nearest neighbors [2]_: a kick of another actor resembles kicks closer to the query.

    Parameters
    ----------
    query : Motion, Tracks or JointRecording
        For sensor data (points with confidences) the mean posture has less weight, because
        sensors place joints differently. Gaps are filled with the most probable postures;
        body parts with little data have little weight.
    library : ClipLibrary
    settings : FindSettings
    ignore : collection of str, optional
        Names of clips to leave out, such as the query itself.
    progress : Progress

    Returns
    -------
    tuple of Match
        Best first. A part of a long clip is returned if it matches better. Frames are those
        of the aligned path for the best matches and those of the indexed segment for others.

    Raises
    ------
    InvalidMotionError
        The query shows no body, or none of the compared parts was tracked.

    References
    ----------
    .. [1] Sivic, Zisserman (2003). Video Google. ICCV. doi:10.1109/ICCV.2003.1238663
    .. [2] Arandjelovic, Zisserman (2012). Three things everyone should know to improve object
       retrieval. CVPR. doi:10.1109/CVPR.2012.6248018
    """
    progress(0.0, "Searching")
    postures = clip_postures(query, CLIP_RATE_HZ)
    vocabulary, entries = library.vocabulary, library.numbered()
    if vocabulary is None or not entries:
        return ()
    settings = settings_for(query, settings)
    described = describe_query(postures, vocabulary, settings)
    ignored = library.numbers_of(ignore)
    if settings.method is FindMethod.PUBLISHED:
        ranking = rank_pyramids(postures, library, ignored, progress=within(progress, 0.0, 0.3))
    else:
        ranking = rank_clips(
            described.segments, described.weights, library.search_index, settings, ignored
        )
    matches = build_matches(ranking, entries, settings)
    aligner = ClipAligner(query, described, vocabulary)
    aligning = within(progress, 0.3, 1.0)
    for rank in range(min(settings.n_aligned, len(matches))):
        aligning(rank / settings.n_aligned, "Aligning")
        number = int(ranking.clips[rank])
        postures = library.postures(number, int(ranking.frames[rank, 1]))
        matches[rank] = aligner.match(
            matches[rank], entries[number], postures, ranking.frames[rank]
        )
    progress(1.0)
    return tuple(matches)


def settings_for(query: Recording, settings: FindSettings) -> FindSettings:
    """Return the settings for a query, which may be of a sensor."""
    is_sensor = isinstance(query, JointRecording) or (
        isinstance(query, Tracks) and query.confidence is not None
    )
    return settings.for_sensor() if is_sensor else settings


def build_matches(
    ranking: Ranking, entries: Mapping[int, ClipEntry], settings: FindSettings
) -> list[Match]:
    """Build the requested matches, with the frames of the segments."""
    max_matches = settings.n_matches or len(ranking.clips)
    clips = [entries[number] for number in ranking.clips[:max_matches].tolist()]
    lengths = np.array([clip.n_frames for clip in clips], dtype=np.intp)
    rates = np.array([clip.frame_rate for clip in clips])
    segments = ranking.frames[:max_matches]
    starts = _clip_frames(segments[:, 0], lengths, rates).tolist()
    stops = (_clip_frames(segments[:, 1] - 1, lengths, rates) + 1).tolist()
    scores = np.exp(
        -SCORE_DECAY * np.maximum(ranking.distances[:max_matches].astype(float), 0.0)
    )
    return [
        Match(clip.name, range(start, stop), score)
        for clip, start, stop, score in zip(clips, starts, stops, scores.tolist(), strict=True)
    ]


def _clip_frames(
    frames: NDArray[np.integer[Any]], n_frames: int | Integers, frame_rate: float | Array
) -> Integers:
    """Convert index frames to frames of a recording; the last frames correspond."""
    last = np.asarray((n_frames - 1) * CLIP_RATE_HZ / frame_rate + ROUNDING_FRAMES).astype(
        np.intp
    )
    recording_frames = np.round(frames / CLIP_RATE_HZ * frame_rate).astype(np.intp)
    return np.where(frames >= last, n_frames - 1, np.minimum(recording_frames, n_frames - 1))


class ClipAligner:
    """Align a query with clips."""

    def __init__(
        self, query: Recording, described: DescribedQuery, vocabulary: Vocabulary
    ) -> None:
        self._weights = np.sqrt(described.weights)[:, None]
        features = described.features * self._weights
        self._features = features.reshape(len(features), -1)
        self._vocabulary = vocabulary
        frames = query.tracks if isinstance(query, JointRecording) else query
        self._n_frames, self._frame_rate = frames.n_frames, frames.frame_rate

    def match(
        self,
        match: Match,
        entry: ClipEntry,
        clip: ClipPostures,
        segment: NDArray[np.int32],
    ) -> Match:
        """Return a match with the frames that the query is aligned with, near a segment."""
        start, stop = segment.tolist()
        margin = round(MARGIN_FRACTION * (stop - start))
        first = max(start - margin, 0)
        window = slice(first, stop + margin)
        excerpt = ClipPostures(
            clip.positions[window], clip.root_velocity[window], clip.frame_rate
        )
        features = self._vocabulary.features(excerpt)
        weighted = (features * self._weights).reshape(len(features), -1)
        path = align_frames(self._features, weighted)
        clip_frames = _clip_frames(path[:, 1] + first, entry.n_frames, entry.frame_rate)
        query_frames = _clip_frames(path[:, 0], self._n_frames, self._frame_rate)
        return replace(
            match,
            frames=range(int(clip_frames[0]), int(clip_frames[-1]) + 1),
            alignment=np.column_stack([query_frames, clip_frames]),
        )
