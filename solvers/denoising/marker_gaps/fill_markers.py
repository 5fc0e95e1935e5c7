"""Fill long gaps of points from the points that are seen, before the take is filtered."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...motion import Tracks
from ...progress import Progress, unwatched
from ...signals import interpolated, runs
from .gap_boundaries import bridge, expected_error, frames_to_learn, usual_jitter
from .predict_marker import foretell
from .reference_markers import find_companions
from .transient_outliers import stray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
Gap = tuple[int, int, int, int]
"""Length, point, first frame, frame after the last."""

BRIEF = 4
"""Frames: so short a gap is left to the filter; its neighbours tell enough."""
LIKE_SEEN = 0.25
"""Of a gap's length: other points' gaps up to so long hardly matter, once filled."""
MOST_GAPS = 12
"""Gaps of one point that are filled together."""
FEWEST_LEARNED = 12
N_ROUNDS = 3
"""Times that what is left of a gap is tried with other companions."""


@dataclass(frozen=True, eq=False)
class FilledMarkers:
    """A take without those gaps that its own points can fill."""

    tracks: Tracks
    """NaN is left where gaps are brief, or where fewer than three other points are seen."""
    filled: Flags
    """Shape (n_frames, n_points)."""
    deviation: Array
    """Expected error of a coordinate where filled, metres, elsewhere 0; same shape."""


@dataclass(frozen=True, eq=False)
class _Take:
    positions: Array
    gap_length: NDArray[np.intp]
    """Frames of the gap that each sample is in; 0 where seen, shape (n_frames, n_points)."""
    known: Flags
    deviation: Array
    frame_rate: float


def fill_markers(tracks: Tracks, progress: Progress = unwatched) -> FilledMarkers:
    """Foretell lost points in the frame of those that keep their distance to them.

    Everything is learned from the take itself: which points move along with the lost one, and
    how its place among them depends on their pose and on time. What was foretold wrongly at
    the borders of a gap is made up for within it. The expected error is that of frames in
    which the point is seen, left out by stretches as long as the gap. In PMA's terms [1]_ it is
    a local and nonlinear regression, averaged as in [2]_.

    Parameters
    ----------
    tracks : Tracks
        NaN where not observed. What was seen is returned as it is.
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
    lost = ~tracks.visible
    if not lost.any():
        return FilledMarkers(tracks, lost, np.zeros(lost.shape))
    take = _read(tracks)
    for _ in range(N_ROUNDS):
        gaps = _open_gaps(take)
        for number, (length, point, start, stop) in enumerate(gaps):
            progress(number / len(gaps), "Filling gaps")
            if not take.known[start:stop, point].all():
                _fill(take, point, length, gaps)
    filled = take.known & (take.gap_length > BRIEF) & lost
    places = np.where(filled[..., None], take.positions, tracks.positions)
    deviation = np.where(filled, take.deviation, 0.0)
    return FilledMarkers(tracks.with_positions(places), filled, deviation)


def _read(tracks: Tracks) -> _Take:
    """Take spikes for brief gaps, and bridge all gaps for as long as they are open."""
    visible = tracks.visible & ~stray(tracks.positions)
    positions = np.where(visible[..., None], tracks.positions, np.nan)
    gap_length = np.zeros(visible.shape, dtype=np.intp)
    for point in np.flatnonzero(~visible.all(axis=0)):
        for start, stop in runs(~visible[:, point]):
            gap_length[start:stop, point] = stop - start
    return _Take(
        interpolated(positions.reshape(len(positions), -1)).reshape(positions.shape),
        gap_length,
        (gap_length <= BRIEF) & visible.any(axis=0),
        np.zeros(visible.shape),
        tracks.frame_rate,
    )


def _open_gaps(take: _Take) -> list[Gap]:
    """Return all gaps that are not filled yet, the shortest first."""
    points = np.flatnonzero(~take.known.all(axis=0) & take.known.any(axis=0))
    return sorted(
        (stop - start, int(point), start, stop)
        for point in points
        for start, stop in runs(~take.known[:, point])
    )


def _fill(take: _Take, point: int, length: int, gaps: list[Gap]) -> None:
    """Fill the gaps of a point that are of this length or a little longer, all at once."""
    alike = [
        (start, stop)
        for size, other, start, stop in gaps
        if other == point and length <= size <= length / LIKE_SEEN
        and not take.known[start:stop, point].all()
    ][:MOST_GAPS]  # fmt: skip
    first = slice(*alike[0])
    seen = take.gap_length[:, point] == 0
    there = take.known & (take.gap_length <= LIKE_SEEN * length)
    gap = np.zeros(len(seen), dtype=bool)
    gap[first] = True
    companions = find_companions(take.positions, seen, there, point, gap)
    if companions is None or len(companions.learned) < FEWEST_LEARNED:
        return
    whole = there[:, companions.points].all(axis=1)
    for start, stop in alike[1:]:
        gap[start:stop] = whole[start:stop].all()
    learned = frames_to_learn(companions.learned, seen & whole, gap, take.frame_rate, len(gaps))
    foretold = np.flatnonzero(gap & whole)
    companions = companions._replace(learned=learned, foretold=foretold)
    result = foretell(take.positions, point, companions, take.frame_rate, length)
    missed = take.positions[learned, point] - result.places[: len(learned)]
    noise = usual_jitter(np.where(seen[:, None], take.positions[:, point], np.nan))
    step = bridge(missed, learned, foretold, noise, take.frame_rate)
    take.positions[foretold, point] = result.places[len(learned) :] + step
    take.deviation[foretold, point] = expected_error(result, gap)[whole[gap]]
    take.known[foretold, point] = True
