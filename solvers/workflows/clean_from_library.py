"""Clean a take with what a library of clips knows of such movements."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from ..denoising import (
    Denoised,
    DenoiseSettings,
    FilterBases,
    FilterBasesSettings,
    denoise,
    learn_filter_bases,
)
from ..errors import InvalidMotionError
from ..motion import JointLimits, Motion, Tracks
from ..progress import Progress, unwatched, within
from ..retrieval import ClipLibrary, FindSettings
from .foretell_lost import foretell_lost
from .library_clips import FOUND, Fetch, library_clips, read_origin

USUAL, LEARNING = DenoiseSettings(), FilterBasesSettings()
BELIEVED = 0.5
"""Confidence of a first estimate from which on it is searched with."""
STEEPNESS = 2.0
"""Power of its score by which a clip counts."""
TINY = 1e-3
SURE = 0.25
"""Score of the best from which on clips are believed to be of the same movement; below, they
have to prove it where joints were lost."""
LAID_ASIDE = "They foretell the joints that are lost worse than the take itself: laid aside."


@dataclass(frozen=True, eq=False)
class LibraryBases:
    """What clips of a library that are like a take teach of it."""

    bases: FilterBases | None
    """None where there is nothing to learn from."""
    clips: tuple[str, ...]
    """Names of those that were learned from, the most alike first."""
    message: str
    """A sentence on them, and on those that could not be read."""


def clean_from_library(
    recording: Motion | Tracks,
    library: ClipLibrary,
    *,
    limits: JointLimits | None = None,
    settings: DenoiseSettings = USUAL,
    finding: FindSettings = FOUND,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> Denoised:
    """Find clips that are like a take, learn from them, and denoise it.

    Parameters
    ----------
    recording : Motion or Tracks
        Of a body; NaN where not observed.
    library : ClipLibrary
    limits : JointLimits, optional
    settings : DenoiseSettings
    finding : FindSettings
        How many clips are learned from, and by which parts of the body they are found.
    ignore : names of clips, optional
        That are not learned from, as the take itself.
    fetch : callable, optional
        Returns a clip's recording; it is read from the file it came from without.
    progress : Progress

    Returns
    -------
    Denoised
        `prior_used` says which clips were learned from, and what became of that.

    Raises
    ------
    InvalidMotionError
        The take shows no body, or nothing was observed.
    SolveCancelled
        Raised by `progress`.
    """
    learned = bases_from_library(
        recording, library, finding=finding, ignore=ignore, fetch=fetch,
        progress=within(progress, 0.0, 0.5),
    )  # fmt: skip
    cleaned = denoise(
        recording, learned.bases, limits=limits, settings=settings,
        progress=within(progress, 0.5, 1.0),
    )  # fmt: skip
    return replace(cleaned, prior_used=f"{learned.message} {cleaned.prior_used}")


def bases_from_library(
    recording: Motion | Tracks,
    library: ClipLibrary,
    *,
    finding: FindSettings = FOUND,
    learning: FilterBasesSettings = LEARNING,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> LibraryBases:
    """Learn filter bases of those clips of a library that are like a dirty take.

    The more a clip is like it, the more it counts. Where joints were lost for long, clips that
    are only roughly like it must fill them at least as well as the take itself does, tried
    where they were seen: else they are laid aside. The library is searched with a first
    estimate from the take alone, and with nothing of what that is unsure of, such as limbs
    that were lost for long.

    Raises
    ------
    InvalidMotionError
        The take is of points or shows no body, or nothing was observed.
    SolveCancelled
        Raised by `progress`.
    """
    if not isinstance(recording, Motion):
        raise InvalidMotionError(
            "Points are not cleaned from a library of skeletons; solve a skeleton from them"
            " first, or rebuild poses from them (reconstruct)."
        )
    query = _believed(recording, within(progress, 0.0, 0.4))
    found = library_clips(
        query, library, settings=finding, ignore=ignore, fetch=fetch,
        progress=within(progress, 0.4, 0.7),
    )  # fmt: skip
    names = tuple(match.clip for match in found.matches)
    if not names:
        return LibraryBases(None, (), found.sentence())
    try:
        bases = learn_filter_bases(
            found.motions,
            weights=[max(match.score, TINY) ** STEEPNESS for match in found.matches],
            settings=learning,
            progress=within(progress, 0.7, 0.85),
        )
    except InvalidMotionError as error:
        return LibraryBases(None, (), f"{found.sentence()} That was of no use: {error}")
    sure = found.matches[0].score >= SURE
    if not sure and not foretell_lost(recording, bases, within(progress, 0.85, 1.0)):
        return LibraryBases(None, (), f"{found.sentence()} {LAID_ASIDE}")
    return LibraryBases(bases, names, found.sentence())


def _believed(recording: Motion, progress: Progress) -> Motion:
    """Return a first estimate, with NaN for what is hardly more than a guess."""
    rough = denoise(recording, progress=progress)
    assert isinstance(rough.recording, Motion)
    unsure = (rough.confidence < BELIEVED)[..., None]
    return rough.recording.with_poses(
        rotations=np.where(unsure, np.nan, rough.recording.rotations)
    )
