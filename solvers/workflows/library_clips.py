"""Find the clips of a library that are similar to a take, and read them."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from ..errors import MocapAssistError, SolveCancelled
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched, within
from ..recordings import read_tracked
from ..retrieval import ClipEntry, ClipLibrary, FindSettings, Match, find_similar
from .clip_sources import is_action

Recording = Motion | Tracks | JointRecording
Fetch = Callable[[ClipEntry], Recording]
"""Returns the recording of a clip."""

CONTEXT_S = 0.5
"""Seconds before and after a match that are included. Chosen by hand, see
`test_only_matching_frames_are_learned_from`."""
MAX_NAMED_CLIPS = 5
FIND_SETTINGS = FindSettings(n_matches=12, n_aligned=12, n_neighbors=0, warping=1.0, busy=0.0)
"""Ranks by similarity of the complete body to the take, without re-ranking: the best clips of a
library without similar motion are still similar to each other."""
MIN_BEST_SCORE = 0.16
"""Minimum score, a ratio, of the best match. Measured: the same movement by another actor
scores 0.2 to 0.5 (HDM05, CMU walks), other movements at most 0.15. If the best match passes,
all matches are used."""


@dataclass(frozen=True, eq=False)
class LibraryClips:
    """Similar clips to learn from.

    Attributes
    ----------
    motions : tuple of Motion
        The matching segments of the clips, best first.
    matches : tuple of Match
        The corresponding matches.
    remarks : tuple of str
        A sentence for each matching clip that could not be read.
    """

    motions: tuple[Motion, ...]
    matches: tuple[Match, ...]
    remarks: tuple[str, ...]

    def sentence(self) -> str:
        """Return a sentence on the clips that are used."""
        if not self.matches:
            return " ".join(["No clip of the library is similar to this take.", *self.remarks])
        listed = ", ".join(match.clip for match in self.matches[:MAX_NAMED_CLIPS])
        more = len(self.matches) - MAX_NAMED_CLIPS
        n_clips = len(self.matches)
        learned = f"Learned from {n_clips} clips of the library: {listed}."
        if n_clips == 1:
            learned = f"Learned from 1 clip of the library: {listed}."
        elif more > 0:
            learned = f"Learned from {n_clips} clips of the library: {listed} and {more} more."
        return " ".join([learned, *self.remarks])


def read_origin(entry: ClipEntry) -> Recording:
    """Read a clip from its source file.

    Raises
    ------
    InvalidFileError
        The file is gone, or no longer a recording.
    """
    origin = entry.origin
    if origin is None or is_action(origin):
        raise MocapAssistError(f"The source file of {entry.name} cannot be read here.")
    return read_tracked(Path(origin.path), body=origin.item)


def library_clips(
    query: Recording,
    library: ClipLibrary,
    *,
    settings: FindSettings = FIND_SETTINGS,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    min_score: float = MIN_BEST_SCORE,
    progress: Progress = unwatched,
) -> LibraryClips:
    """Find clips similar to a take, and read their matching segments.

    Parameters
    ----------
    query : Motion, Tracks or JointRecording
        NaN where observations are unreliable.
    library : ClipLibrary
    settings : FindSettings
    ignore : names of clips, optional
    fetch : callable, optional
        Returns the recording of a clip; by default it is read from its source file.
    min_score : float
        Minimum score of the best match; below it there are no clips.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The query shows no body.
    SolveCancelled
        Raised by `progress`.
    """
    matches = find_similar(
        query, library, settings=settings, ignore=ignore, progress=within(progress, 0, 0.3)
    )
    if matches and matches[0].score < min_score:
        matches = ()
    entries = {entry.name: entry for entry in library.entries}
    motions, used, remarks = [], [], []
    for index, match in enumerate(matches):
        progress(0.3 + 0.7 * index / len(matches), f"Reading {match.clip}")
        try:
            clip = fetch(entries[match.clip])
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            remarks.append(f"{match.clip} was left out: {error}")
            continue
        if isinstance(clip, Motion):  # Sensor recordings are not clean examples.
            motions.append(_matching_segment(clip, match))
            used.append(match)
    progress(1.0)
    return LibraryClips(tuple(motions), tuple(used), tuple(remarks))


def _matching_segment(clip: Motion, match: Match) -> Motion:
    context = round(CONTEXT_S * clip.frame_rate)
    start = max(match.frames.start - context, 0)
    segment = clip.slice(start, min(match.frames.stop + context, clip.n_frames))
    return segment if segment.n_frames else clip
