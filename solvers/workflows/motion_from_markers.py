"""From the markers of an optical take to the clean motion of a skeleton."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..denoising import denoise
from ..denoising.marker_gaps import fill_markers
from ..markers import (
    SolvedSkeleton,
    SolveSettings,
    Swap,
    UnswapSettings,
    constrain_clusters,
    find_marker_set,
    find_rigid_clusters,
    solve_skeleton,
    unswap_markers,
)
from ..motion import Motion, Tracks
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting

SOLVE_SETTINGS = SolveSettings()


@dataclass(frozen=True, kw_only=True)
class MarkerMotionSettings(Settings):
    """Which steps are taken."""

    unswap: bool = setting(
        True, "Fix swapped and wrong marker labels first", label="Fix Swapped Labels"
    )
    evidence: float = setting(
        8.0, "Evidence needed to change a label; higher changes fewer labels",
        minimum=1.0, maximum=100.0, label="Swap Threshold",
    )  # fmt: skip
    fill: bool = setting(True, "Fill marker gaps from neighboring markers", label="Fill Gaps")
    smooth: bool = setting(
        False,
        "Remove jitter from the solved motion; otherwise only hidden joints are filled",
        label="Remove Jitter",
    )


@dataclass(frozen=True, eq=False)
class MarkerMotion:
    """A skeleton's motion without gaps, and what was done for it."""

    motion: Motion
    solved: SolvedSkeleton
    """Before what no marker shows was filled."""
    markers: Tracks
    """The markers of the set, as they were solved from."""
    swaps: tuple[Swap, ...]
    filled: NDArray[np.bool_]
    """Where one of `markers` was found from others, shape (n_frames, n_points)."""


def motion_from_markers(
    tracks: Tracks,
    *,
    settings: MarkerMotionSettings = MarkerMotionSettings(),
    solving: SolveSettings = SOLVE_SETTINGS,
    progress: Progress = unwatched,
) -> MarkerMotion:
    """Put labels right, fill gaps, solve the skeleton and fill what is left.

    Lost markers are found from their rigid cluster where three others of it are seen, else by
    `fill_markers`. Markers that are seen stay where they are; the fit of the skeleton averages.

    Parameters
    ----------
    tracks : Tracks
        Labelled markers of a set known to `find_marker_set`.
    settings : MarkerMotionSettings
    solving : SolveSettings
    progress : Progress

    Raises
    ------
    InvalidMotionError
        Markers of the pelvis or the legs are missing.
    SolveCancelled
        Raised by `progress`.
    """
    markers = _of_the_set(tracks, solving.subject)
    swaps: tuple[Swap, ...] = ()
    if settings.unswap:
        unswapped = unswap_markers(
            markers,
            settings=UnswapSettings(evidence=settings.evidence),
            progress=within(progress, 0.0, 0.2),
        )
        markers, swaps = unswapped.tracks, unswapped.swaps
    labelled = markers.visible
    if settings.fill:
        markers = _filled(markers, within(progress, 0.2, 0.5))
    solved = solve_skeleton(markers, settings=solving, progress=within(progress, 0.5, 0.85))
    motion = solved.motion
    if settings.smooth or not motion.observed.all():
        done = denoise(motion, progress=within(progress, 0.85, 1.0)).recording
        assert isinstance(done, Motion)
        motion = done if settings.smooth else _gaps_only(motion, done)
    progress(1.0, "Done")
    return MarkerMotion(motion, solved, markers, swaps, markers.visible & ~labelled)


def _of_the_set(tracks: Tracks, subject: str) -> Tracks:
    """Leave out points that no marker set knows, such as joints that a program computed."""
    known = set(find_marker_set(tracks.names, subject or None).markers.values())
    kept = [index for index, name in enumerate(tracks.names) if name in known]
    if not kept:
        return tracks  # Whose lack of markers the solver tells best.
    names = tuple(tracks.names[index] for index in kept)
    confidence = None if tracks.confidence is None else tracks.confidence[:, kept]
    return Tracks(names, tracks.positions[:, kept], tracks.frame_rate, confidence)


def _filled(tracks: Tracks, progress: Progress) -> Tracks:
    """Fill gaps from rigid clusters, then from all companions."""
    clusters = find_rigid_clusters(tracks, progress=within(progress, 0.0, 0.1))
    kept = constrain_clusters(tracks, clusters, progress=within(progress, 0.1, 0.2))
    found = np.where(kept.filled[..., None], kept.tracks.positions, tracks.positions)
    return fill_markers(tracks.with_positions(found), within(progress, 0.2, 1.0)).tracks


def _gaps_only(motion: Motion, filled: Motion) -> Motion:
    """Take from the filled motion only what was not known."""
    rotations = np.where(np.isnan(motion.rotations), filled.rotations, motion.rotations)
    places = np.where(
        np.isnan(motion.root_positions), filled.root_positions, motion.root_positions
    )
    return motion.with_poses(rotations, places)
