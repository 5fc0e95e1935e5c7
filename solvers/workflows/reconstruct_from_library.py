"""Rebuild poses with postures from the clips of a library that are similar to the take."""

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
from ..reconstruction.pose_library import build_posture_library, merge_posture_libraries
from ..retrieval import ClipLibrary, FindSettings
from .library_clips import FIND_SETTINGS, Fetch, library_clips, read_origin
from .reconstruct_motion import postures_recording

RECONSTRUCT_SETTINGS = ReconstructSettings()
MIN_QUERY_RELIABILITY = 0.5
"""Minimum reliability of a joint in the query. By definition that of a joint that a tracker
inferred, 0.5 at most."""


@dataclass(frozen=True, eq=False)
class LibraryPostures:
    """Postures for the reconstruction of a take: of similar clips, and the shipped ones."""

    postures: PostureLibrary
    clips: tuple[str, ...]
    """Names of the clips, most similar first."""
    message: str
    """A sentence on these clips and on those that could not be read."""


def reconstruct_from_library(
    recording: JointRecording,
    library: ClipLibrary,
    prior: ResidualPrior | None = None,
    *,
    settings: ReconstructSettings = RECONSTRUCT_SETTINGS,
    finding: FindSettings = FIND_SETTINGS,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> Reconstruction:
    """Find clips similar to a recording, and rebuild its poses from their postures.

    Parameters
    ----------
    recording : JointRecording
    library : ClipLibrary
    prior : ResidualPrior, optional
    settings : ReconstructSettings
    finding : FindSettings
        Number of clips to use, and the weights of body parts in the search.
    ignore : names of clips, optional
        Clips to leave out, such as the recording itself.
    fetch : callable, optional
        Returns the recording of a clip; by default it is read from its source file.
    progress : Progress

    Returns
    -------
    Reconstruction
        `method` names the clips.

    Raises
    ------
    InvalidMotionError
        No body is recognized in the names, or too few joints are observed.
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
    finding: FindSettings = FIND_SETTINGS,
    ignore: Collection[str] = (),
    fetch: Fetch = read_origin,
    progress: Progress = unwatched,
) -> LibraryPostures:
    """Collect postures from the clips of a library that are similar to a take.

    The query holds the reliable joints. The shipped postures are included: without similar
    clips, the result is the same as without a library.

    Raises
    ------
    InvalidMotionError
        No body is recognized.
    SolveCancelled
        Raised by `progress`.
    """
    if isinstance(recording, Motion):
        recording = postures_recording(recording)
    reliability = measure_reliability(recording, progress=within(progress, 0.0, 0.2)).combined
    tracks = recording.tracks
    reliable = np.where(
        (reliability >= MIN_QUERY_RELIABILITY)[..., None], tracks.positions, np.nan
    )
    found = library_clips(
        replace(recording, tracks=tracks.with_positions(reliable)), library,
        settings=finding, ignore=ignore, fetch=fetch, min_score=0.0,
        progress=within(progress, 0.2, 0.7),
    )  # fmt: skip
    shipped, names = load_posture_library(), tuple(match.clip for match in found.matches)
    if not names:
        return LibraryPostures(shipped, (), found.sentence())
    source = f"{len(names)} clips of a library"
    try:
        own = build_posture_library(
            found.motions, trained_on=source, progress=within(progress, 0.7, 1.0)
        )
    except InvalidMotionError as error:
        return LibraryPostures(shipped, (), f"{found.sentence()} They cannot be used: {error}")
    return LibraryPostures(merge_posture_libraries(own, shipped), names, found.sentence())
