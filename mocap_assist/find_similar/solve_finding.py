"""Solve of the button Find Similar: the best clips, and their details."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    estimate_bone_lengths,
    normalize_postures,
    posture_positions,
    postures_from_motion,
)
from ...solvers.progress import Progress, unwatched, within
from ...solvers.retrieval import (
    ClipEntry,
    ClipLibrary,
    FindSettings,
    Match,
    find_similar,
    load_clip_library,
)
from ..library.solve_prior import Own, own_clips
from ..library.thumbnails import Pixels, thumbnail

Recording = Motion | Tracks | JointRecording

MAX_MATCHES = 48
"""Maximum number of listed matches."""
BROWSED_HZ = 30.0
"""Frames per second of the query that stands for none while the library is browsed. By
definition."""


@dataclass(frozen=True, eq=False)
class FindProblem:
    """A query, and the library to search."""

    query: Recording
    library: str
    settings: FindSettings
    own: Own = ()
    """Files and actions of the query itself; they are not listed."""


@dataclass(frozen=True, eq=False)
class QueryPath:
    """Position of the query in each frame, and the proportions of the actor."""

    positions: Array
    """Of the hips, shape (n_frames, 3), meters."""
    headings: Array
    """Shape (n_frames,), radians."""
    lengths: Array
    """Of the actor's bones, shape (20,), meters."""
    frame_rate: float


@dataclass(frozen=True, eq=False)
class Found:
    """A clip similar to the query, with the data to display it."""

    entry: ClipEntry
    match: Match
    postures: NDArray[np.float32]
    """Of the frames that match, at `rate`: shape (n, 20, 3), meters; see `ClipPostures`."""
    rate: float
    picture: Pixels

    @property
    def pairs(self) -> NDArray[np.intp]:
        """Frames of the query and of the clip that belong together, shape (n, 2)."""
        assert self.match.alignment is not None
        return self.match.alignment


@dataclass(frozen=True, eq=False)
class Finding:
    """Matches of a search."""

    found: tuple[Found, ...]
    stage: QueryPath
    n_clips: int
    """In the library."""
    first: int | None = None
    """Place in the library of the first of its clips that are listed; None for a search."""


def find_clips(problem: FindProblem, *, progress: Progress = unwatched) -> Finding:
    """Search a library, and draw the matches.

    Raises
    ------
    InvalidFileError
        The library is missing or cannot be read.
    InvalidMotionError
        The query has no body, or none of the parts to compare.
    """
    stage = stage_of(problem.query)
    n_matches = min(problem.settings.n_matches or MAX_MATCHES, MAX_MATCHES)
    with load_clip_library(Path(problem.library)) as library:
        entries = library.numbered()
        settings = replace(
            problem.settings,
            n_matches=n_matches,
            n_aligned=n_matches,
        )
        matches = find_similar(
            problem.query,
            library,
            settings=settings,
            ignore=own_clips(library, problem.own),
            progress=within(progress, 0.0, 0.7),
        )
        numbers = {entry.name: number for number, entry in entries.items()}
        found = []
        for index, match in enumerate(matches):
            progress(0.7 + 0.3 * index / len(matches), "Drawing")
            found.append(_found_from_match(match, numbers[match.clip], library))
    return Finding(tuple(found), stage, len(entries))


def list_clips(library: str, first: int, *, progress: Progress = unwatched) -> Finding:
    """List some clips of a library, unranked, from an index on.

    Beyond its last clip, as it may have shrunk, those from the first one on are shown.

    Raises
    ------
    InvalidFileError
        The library is missing or cannot be read.
    """
    with load_clip_library(Path(library)) as clips:
        entries = clips.numbered()
        first = first if first < len(entries) else 0
        numbers = list(entries)[first : first + MAX_MATCHES]
        found = []
        for index, number in enumerate(numbers):
            progress(index / len(numbers), "Drawing")
            found.append(_found_from_match(_complete_match(entries[number]), number, clips))
    stage = QueryPath(np.zeros((1, 3)), np.zeros(1), ADULT_BONE_LENGTHS_M, BROWSED_HZ)
    return Finding(tuple(found), stage, len(entries), first)


def _complete_match(entry: ClipEntry) -> Match:
    """Return a complete clip as its own match."""
    last = np.array([(entry.n_frames - 1) / entry.frame_rate * BROWSED_HZ, entry.n_frames - 1])
    alignment = np.stack([np.zeros(2), last]).round().astype(np.intp)
    return Match(entry.name, range(entry.n_frames), 1.0, alignment)


def _found_from_match(match: Match, number: int, library: ClipLibrary) -> Found:
    entry, postures = library.numbered()[number], library.postures(number)
    per_frame = postures.frame_rate / entry.frame_rate
    first = min(int(match.frames.start * per_frame), postures.n_frames - 1)
    stop = int(np.ceil(match.frames.stop * per_frame))
    part = postures.positions[first : max(stop, first + 1)].astype(np.float32)
    return Found(entry, match, part, postures.frame_rate, thumbnail(part.astype(np.float64)))


def stage_of(query: Recording) -> QueryPath:
    """Return the position of a recording and the proportions of its actor.

    Raises InvalidMotionError where no body is recognized in it.
    """
    tracks = query.tracks if isinstance(query, JointRecording) else query
    if isinstance(tracks, Motion):
        positions = postures_from_motion(tracks)
    else:
        positions = posture_positions(tracks)
    body = normalize_postures(positions, tracks.frame_rate)
    lengths = estimate_bone_lengths(body.postures)
    return QueryPath(body.hip_positions, np.unwrap(body.headings), lengths, tracks.frame_rate)
