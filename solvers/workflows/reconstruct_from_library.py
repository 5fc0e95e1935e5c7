"""Rebuild poses with postures of those clips of a library that are like the take."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from ..errors import InvalidMotionError
from ..motion import JointRecording, Motion
from ..progress import Progress, unwatched, within
from ..reconstruction import (
    PostureLibrary,
    Reconstruction,
    ReconstructSettings,
    ResidualPrior,
    load_posture_library,
    measure_reliability,
    reconstruct,
)
from ..reconstruction.pose_library import build_posture_library, joined_postures
from ..retrieval import ClipLibrary, FindSettings
from .library_clips import FOUND, Fetch, library_clips, read_origin
from .reconstruct_motion import postures_recording

USUAL = ReconstructSettings()
BELIEVED = 0.5
"""Reliability from which on a joint is searched with."""


@dataclass(frozen=True, eq=False)
class LibraryPostures:
    """Postures to rebuild a take from: of clips that are like it, and what is shipped."""

    postures: PostureLibrary
    clips: tuple[str, ...]
    """Names of those that were found, the most alike first."""
    message: str
    """A sentence on them, and on those that could not be read."""


def reconstruct_from_library(
    recording: JointRecording,
    library: ClipLibrary,
    prior: ResidualPrior | None = None,
    *,
    settings: ReconstructSettings = USUAL,
    finding: FindSettings = FOUND,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Find clips that are like what a tracker saw, and rebuild its poses from theirs.

    Parameters
    ----------
    recording : JointRecording
    library : ClipLibrary
    prior : ResidualPrior, optional
    settings : ReconstructSettings
    finding : FindSettings
        How many clips are asked, and by which parts of the body they are found.
    ignore : names of clips, optional
        That are not asked, as the recording itself.
    fetch : callable, optional
        Returns a clip's recording; it is read from the file it came from without.
    progress : Progress

    Returns
    -------
    Reconstruction
        `method` says which clips were asked.

    Raises
    ------
    InvalidMotionError
        No body is recognised in the names, or hardly a joint was ever seen.
    SolveCancelled
        Raised by `progress`.
    """
    found = postures_from_library(
        recording, library, finding=finding, ignore=ignore, fetch=fetch,
        progress=within(progress, 0.0, 0.4),
    )  # fmt: skip
    rebuilt = reconstruct(
        recording, found.postures, prior, settings=settings,
        progress=within(progress, 0.4, 1.0),
    )  # fmt: skip
    return replace(rebuilt, method=f"{found.message.rstrip('.')}; {rebuilt.method}")


def postures_from_library(
    recording: JointRecording | Motion,
    library: ClipLibrary,
    *,
    finding: FindSettings = FOUND,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> LibraryPostures:
    """Collect postures of those clips of a library that are like a take.

    It is searched with the joints that are reliable. What is shipped is among them: where a
    library knows nothing of a movement, all is as without one.

    Raises
    ------
    InvalidMotionError
        No body is recognised.
    SolveCancelled
        Raised by `progress`.
    """
    if isinstance(recording, Motion):
        recording = postures_recording(recording)
    trust = measure_reliability(recording, progress=within(progress, 0.0, 0.2)).combined
    tracks = recording.tracks
    believed = np.where((trust >= BELIEVED)[..., None], tracks.positions, np.nan)
    found = library_clips(
        replace(recording, tracks=tracks.with_positions(believed)), library,
        settings=finding, ignore=ignore, fetch=fetch, at_least=0.0,
        progress=within(progress, 0.2, 0.7),
    )  # fmt: skip
    shipped, names = load_posture_library(), tuple(match.clip for match in found.matches)
    if not names:
        return LibraryPostures(shipped, (), found.sentence())
    said = f"{len(names)} clips of a library"
    try:
        theirs = build_posture_library(
            found.motions, trained_on=said, progress=within(progress, 0.7, 1.0)
        )
    except InvalidMotionError as error:
        return LibraryPostures(shipped, (), f"{found.sentence()} That was of no use: {error}")
    return LibraryPostures(joined_postures(theirs, shipped), names, found.sentence())
