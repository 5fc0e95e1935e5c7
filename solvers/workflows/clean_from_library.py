"""Clean a take with filter bases learned from similar clips of a library."""

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
from .library_clips import FIND_SETTINGS, Fetch, library_clips, read_origin
from .prior_validation import prior_fills_gaps

DENOISE_SETTINGS, LEARN_SETTINGS = DenoiseSettings(), FilterBasesSettings()
MIN_CONFIDENCE = 0.5
"""Minimum confidence of a joint in the first estimate; others are left out of the query. By
definition of the confidence, at least half of these are more than 5 degrees off."""
WEIGHT_EXPONENT = 2.0
"""Exponent from the score of a clip to its weight. Chosen by hand: a clip of half the score has
a quarter of the weight, see `test_more_similar_clips_have_more_weight`."""
MIN_WEIGHT_SCORE = 1e-3
"""Score, a ratio, of the least similar clips, which may be 0. It guards the sum of the weights
against 0."""
MIN_CONFIDENT_SCORE = 0.25
"""Score, a ratio, of the best match above which the clips count as the same movement. Below it,
they must fill held-out gaps at least as well as the take itself. Measured: the same movement by
another actor scores 0.2 to 0.5."""
PRIOR_REJECTED = (
    "They are not used: they predict the missing joints worse than the take itself."
)


@dataclass(frozen=True, eq=False)
class LibraryBases:
    """Filter bases learned from the clips of a library that are similar to a take."""

    bases: FilterBases | None
    """None if no clip is usable."""
    clips: tuple[str, ...]
    """Names of the clips that were used, most similar first."""
    message: str
    """A sentence on these clips and on those that could not be read."""


def clean_from_library(
    recording: Motion | Tracks,
    library: ClipLibrary,
    *,
    limits: JointLimits | None = None,
    settings: DenoiseSettings = DENOISE_SETTINGS,
    finding: FindSettings = FIND_SETTINGS,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> Denoised:
    """Find clips similar to a take, learn filter bases from them, and denoise it.

    Parameters
    ----------
    recording : Motion or Tracks
        Of a body; NaN where not observed.
    library : ClipLibrary
    limits : JointLimits, optional
    settings : DenoiseSettings
    finding : FindSettings
        Number of clips to learn from, and the weights of body parts in the search.
    ignore : names of clips, optional
        Clips to leave out, such as the take itself.
    fetch : callable, optional
        Returns the recording of a clip; by default it is read from its source file.
    progress : Progress

    Returns
    -------
    Denoised
        `prior_used` names the clips that were used, and the resulting prior.

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
    finding: FindSettings = FIND_SETTINGS,
    learning: FilterBasesSettings = LEARN_SETTINGS,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> LibraryBases:
    """Learn filter bases from the clips of a library that are similar to an unclean take.

    The weight of a clip grows with its similarity. Where the take has long gaps, clips that
    are only roughly similar must fill held-out gaps at least as well as the take itself does;
    otherwise they are rejected. The query is a first estimate from the take alone, without
    its low-confidence joints, such as limbs that are missing for long.

    Raises
    ------
    InvalidMotionError
        The take holds points or no body, or nothing was observed.
    SolveCancelled
        Raised by `progress`.
    """
    if not isinstance(recording, Motion):
        raise InvalidMotionError(
            "A library of skeletons cannot clean points. Solve a skeleton from them first, or"
            " rebuild poses from them (reconstruct)."
        )
    query = _confident_estimate(recording, within(progress, 0.0, 0.4))
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
            weights=[
                max(match.score, MIN_WEIGHT_SCORE) ** WEIGHT_EXPONENT for match in found.matches
            ],
            settings=learning,
            progress=within(progress, 0.7, 0.85),
        )
    except InvalidMotionError as error:
        return LibraryBases(None, (), f"{found.sentence()} They cannot be used: {error}")
    is_confident = found.matches[0].score >= MIN_CONFIDENT_SCORE
    if not is_confident and not prior_fills_gaps(recording, bases, within(progress, 0.85, 1.0)):
        return LibraryBases(None, (), f"{found.sentence()} {PRIOR_REJECTED}")
    return LibraryBases(bases, names, found.sentence())


def _confident_estimate(recording: Motion, progress: Progress) -> Motion:
    """Return a first estimate, with NaN for low-confidence joints."""
    estimate = denoise(recording, progress=progress)
    assert isinstance(estimate.recording, Motion)
    uncertain = (estimate.confidence < MIN_CONFIDENCE)[..., None]
    return estimate.recording.with_poses(
        rotations=np.where(uncertain, np.nan, estimate.recording.rotations)
    )
