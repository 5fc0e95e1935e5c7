"""Fill long gaps of markers from the observed markers, before the take is filtered."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...motion import Tracks
from ...progress import Progress, unwatched
from ...signals import fill_channel_gaps, find_runs
from .gap_boundaries import (
    estimate_gap_error,
    estimate_jitter,
    extrapolate_boundary_errors,
    select_training_frames,
)
from .predict_marker import predict_marker
from .reference_markers import find_reference_markers
from .transient_outliers import find_transient_outliers

Gap = tuple[int, int, int, int]
"""Length, point, first frame, frame after the last."""

MAX_BRIEF_FRAMES = 4
"""Frames: the filter fills gaps this short, because their neighbors in time suffice. Half and
twice gain less than 1 % (`make sensitivity`)."""
MAX_RELATIVE_GAP = 0.25
"""Fraction of a gap's length: filled gaps of other points up to this length hardly matter.
Sweep: x0.1 costs 3.4 %; from 1 on no gap is like any other."""
MAX_GAPS_TOGETHER = 12
"""Gaps of one point that are filled together: their frames are solved at once, so this bounds
the run time of a marker that flickers."""
MIN_TRAINING_FRAMES = 12
"""Frames below which a gap is left to the filter. It guards a marker seen in one frame, whose
gap would be filled with an expected error of zero."""


@dataclass(frozen=True, eq=False)
class FilledMarkers:
    """A take whose gaps are filled from its own markers where possible."""

    tracks: Tracks
    """NaN remains in brief gaps, and where fewer than three other markers are observed."""
    filled: Flags
    """Shape (n_frames, n_points)."""
    deviation: Array
    """Expected error of a coordinate where filled, meters, elsewhere 0; same shape."""


@dataclass(frozen=True, eq=False)
class _Take:
    positions: Array
    gap_length: NDArray[np.intp]
    """Length in frames of each sample's gap; 0 where observed, shape (n_frames, n_points)."""
    usable: Flags
    deviation: Array
    frame_rate: float


def fill_markers(tracks: Tracks, progress: Progress = unwatched) -> FilledMarkers:
    """Predict missing markers in the frame of those at a constant distance from them.

    The take itself is the only training data. It shows which markers move with the missing one,
    and how the missing one's position among them depends on their pose and on time. Errors at
    the boundaries of a gap fade into it. The expected error is that of observed frames, held
    out in blocks as long as the gap. In the terms of PMA [1]_ it is a local and nonlinear
    regression, averaged as in [2]_.

    Parameters
    ----------
    tracks : Tracks
        NaN where not observed. Observed positions are returned unchanged.
    progress : Progress

    Raises
    ------
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Gloersen, Federolf (2016). Predicting missing marker trajectories in human motion
       data using marker intercorrelations. doi:10.1371/journal.pone.0152616
    .. [2] Tits, Tilmanne, Dutoit (2018). doi:10.1371/journal.pone.0199744
    """
    missing = ~tracks.visible
    if not missing.any():
        return FilledMarkers(tracks, missing, np.zeros(missing.shape))
    take = _prepare_take(tracks)
    n_usable = -1
    while n_usable < (n_usable := int(take.usable.sum())):  # with other reference markers
        gaps = _list_open_gaps(take)
        for number, (length, point, start, stop) in enumerate(gaps):
            progress(number / len(gaps), "Filling gaps")
            if not take.usable[start:stop, point].all():
                _fill_point(take, point, length, gaps)
    filled = take.usable & (take.gap_length > MAX_BRIEF_FRAMES) & missing
    positions = np.where(filled[..., None], take.positions, tracks.positions)
    deviation = np.where(filled, take.deviation, 0.0)
    return FilledMarkers(tracks.with_positions(positions), filled, deviation)


def _prepare_take(tracks: Tracks) -> _Take:
    """Treat spikes as brief gaps, and bridge all gaps with lines until they are filled."""
    visible = tracks.visible & ~find_transient_outliers(tracks.positions)
    positions = np.where(visible[..., None], tracks.positions, np.nan)
    gap_length = np.zeros(visible.shape, dtype=np.intp)
    for point in np.flatnonzero(~visible.all(axis=0)):
        for start, stop in find_runs(~visible[:, point]):
            gap_length[start:stop, point] = stop - start
    return _Take(
        fill_channel_gaps(positions.reshape(len(positions), -1)).reshape(positions.shape),
        gap_length,
        (gap_length <= MAX_BRIEF_FRAMES) & visible.any(axis=0),
        np.zeros(visible.shape),
        tracks.frame_rate,
    )


def _list_open_gaps(take: _Take) -> list[Gap]:
    """Return all gaps that are not filled yet, the shortest first."""
    points = np.flatnonzero(~take.usable.all(axis=0) & take.usable.any(axis=0))
    return sorted(
        (stop - start, int(point), start, stop)
        for point in points
        for start, stop in find_runs(~take.usable[:, point])
    )


def _fill_point(take: _Take, point: int, length: int, gaps: list[Gap]) -> None:
    """Fill all gaps of a point of this length, and of up to four times it, at once."""
    similar_gaps = [
        (start, stop)
        for other_length, other, start, stop in gaps
        if other == point and length <= other_length <= length / MAX_RELATIVE_GAP
        and not take.usable[start:stop, point].all()
    ][:MAX_GAPS_TOGETHER]  # fmt: skip
    first_gap = slice(*similar_gaps[0])
    observed = take.gap_length[:, point] == 0
    available = take.usable & (take.gap_length <= MAX_RELATIVE_GAP * length)
    gap = np.zeros(len(observed), dtype=bool)
    gap[first_gap] = True
    references = find_reference_markers(take.positions, observed, available, point, gap)
    if references is None or len(references.training_frames) < MIN_TRAINING_FRAMES:
        return
    all_available = available[:, references.points].all(axis=1)
    for start, stop in similar_gaps[1:]:
        gap[start:stop] = all_available[start:stop].all()
    training_frames = select_training_frames(
        references.training_frames, observed & all_available, gap, take.frame_rate
    )
    gap_frames = np.flatnonzero(gap & all_available)
    references = references._replace(training_frames=training_frames, gap_frames=gap_frames)
    prediction = predict_marker(take.positions, point, references, take.frame_rate, length)
    boundary_errors = (
        take.positions[training_frames, point] - prediction.positions[: len(training_frames)]
    )
    noise = estimate_jitter(np.where(observed[:, None], take.positions[:, point], np.nan))
    correction = extrapolate_boundary_errors(
        boundary_errors, training_frames, gap_frames, noise, take.frame_rate
    )
    take.positions[gap_frames, point] = (
        prediction.positions[len(training_frames) :] + correction
    )
    take.deviation[gap_frames, point] = estimate_gap_error(prediction, gap)[all_available[gap]]
    take.usable[gap_frames, point] = True
