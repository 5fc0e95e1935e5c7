"""Clips of a library to learn from, for one take: those that are like it."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from ..errors import MocapAssistError, SolveCancelled
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched, within
from ..recordings import read_tracked
from ..retrieval import ClipEntry, ClipLibrary, FindSettings, Match, find_similar

Recording = Motion | Tracks | JointRecording
Fetch = Callable[[ClipEntry], Recording]
"""Returns the recording of a clip."""

AROUND = 0.5
"""Seconds before and after what matches that are taken along."""
MOST_NAMED = 5
FOUND = FindSettings(n_matches=12, n_aligned=12, n_alike=0, warping=1.0, busy=0.0)
"""By likeness of the whole body with the take alone: the best that a library without the like
has are like each other all the same."""
ALIKE = 0.16
"""Score that the best must have: the same movement by another actor has one of 0.2 to 0.5
(HDM05, CMU walks), other movements at most 0.15. Where it has, the others help too."""


@dataclass(frozen=True, eq=False)
class LibraryClips:
    """What was found to learn from.

    Attributes
    ----------
    motions : tuple of Motion
        Those parts of the clips that match, best first.
    matches : tuple of Match
        The same as the library tells of them.
    remarks : tuple of str
        A sentence for each clip that matches and could not be had.
    """

    motions: tuple[Motion, ...]
    matches: tuple[Match, ...]
    remarks: tuple[str, ...]

    def sentence(self) -> str:
        """Say which clips are learned from."""
        if not self.matches:
            return " ".join(["Nothing in the library is like this take.", *self.remarks])
        named = ", ".join(match.clip for match in self.matches[:MOST_NAMED])
        more = len(self.matches) - MOST_NAMED
        rest = f" and {more} more" if more > 0 else ""
        clips = "1 clip" if len(self.matches) == 1 else f"{len(self.matches)} clips"
        return " ".join([f"Learned from {clips} of the library: {named}{rest}.", *self.remarks])


def read_origin(entry: ClipEntry) -> Recording:
    """Read a clip again from the file that it came from.

    Raises
    ------
    InvalidFileError
        The file has gone, or is not a recording any more.
    """
    origin = entry.origin
    if origin is None or origin.item:
        raise MocapAssistError(f"{entry.name} came from no file that can be read here.")
    return read_tracked(Path(origin.path))


def library_clips(
    query: Recording,
    library: ClipLibrary,
    *,
    settings: FindSettings = FOUND,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    at_least: float = ALIKE,
    progress: Progress = unwatched,
) -> LibraryClips:
    """Find clips that are like a take, and read the parts of them that are.

    Parameters
    ----------
    query : Motion, Tracks or JointRecording
        NaN where it is not to be believed.
    library : ClipLibrary
    settings : FindSettings
    ignore : names of clips, optional
    fetch : callable, optional
        Returns a clip's recording; it is read from its file without.
    at_least : float
        Score that the best must have; else there is none.
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
    if matches and matches[0].score < at_least:
        matches = ()
    entries = {entry.name: entry for entry in library.entries}
    motions, used, remarks = [], [], []
    for place, match in enumerate(matches):
        progress(0.3 + 0.7 * place / len(matches), f"Reading {match.clip}")
        try:
            clip = fetch(entries[match.clip])
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            remarks.append(f"{match.clip} was left out: {error}")
            continue
        if isinstance(clip, Motion):  # What a sensor saw is no example of what is right.
            motions.append(_part(clip, match))
            used.append(match)
    progress(1.0)
    return LibraryClips(tuple(motions), tuple(used), tuple(remarks))


def _part(clip: Motion, match: Match) -> Motion:
    around = round(AROUND * clip.frame_rate)
    start = max(match.frames.start - around, 0)
    part = clip.slice(start, min(match.frames.stop + around, clip.n_frames))
    return part if part.n_frames else clip
