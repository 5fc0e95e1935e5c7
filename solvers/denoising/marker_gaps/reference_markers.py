"""Choose reference markers for a missing marker and fit their rigid frame."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...rotations import RIGID_POINTS, nearest_rotations

MAX_REFERENCES = 24
"""Reference markers that predict one marker. Chosen by hand; `make sensitivity` varies it."""
MIN_GAP_COVERAGE, MIN_SHARED_FRACTION = 0.8, 0.6
"""Minimum fraction of the gap, and of the frames with the missing marker observed, in which all
reference markers together must be available. Half and twice are no better
(`make sensitivity`)."""
MIN_DISTANCE_M = 0.03
"""Minimum distance, meters, of the second marker from the first, and of the third from their
line. Half and twice are no better (`make sensitivity`)."""
MIN_DEVIATION_M = 0.001
"""Meters: minimum uncertainty of a distance, even if it never varied. Half and twice gain less
than 1 % (`make sensitivity`)."""
N_FITS = 3
"""Alternating fits of the frames and of the mean shape. Sweep: one fit costs 2.4 %, 30 gain
nothing."""


class ReferenceMarkers(NamedTuple):
    """Markers whose distance to a missing one varies least, the first three not on a line."""

    points: NDArray[np.intp]
    deviation: Array
    """Standard deviation of each one's distance to the missing marker, meters."""
    training_frames: NDArray[np.intp]
    """Frames in which the missing marker and all reference markers are available."""
    gap_frames: NDArray[np.intp]
    """Frames of the gap in which all reference markers are available."""


def find_reference_markers(
    positions: Array, observed: Flags, available: Flags, point: int, gap: Flags
) -> ReferenceMarkers | None:
    """Choose the markers that move most rigidly with the missing one.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), meters
    observed : shape (n_frames,)
        Where the missing marker is observed.
    available : shape (n_frames, n_points)
        Where the others can be used.
    point : int
        The missing marker.
    gap : shape (n_frames,)
        Frames to predict.

    Returns
    -------
    ReferenceMarkers, or None if fewer than three markers qualify.
    """
    deviation = _distance_deviations(positions, observed, available, point)
    coverage = available[gap].mean(axis=0)
    usable = np.isfinite(deviation) & (coverage >= MIN_GAP_COVERAGE * coverage.max(initial=0.0))
    usable &= coverage > 0.0
    training_frames, gap_frames = observed.copy(), gap.copy()
    chosen: list[int] = []
    min_shared, min_covered = (
        MIN_SHARED_FRACTION * observed.sum(),
        MIN_GAP_COVERAGE * coverage.max(initial=0.0) * gap.sum(),
    )
    for other in np.argsort(deviation, kind="stable"):
        if not usable[other] or len(chosen) == MAX_REFERENCES:
            continue
        shared, covered = (
            training_frames & available[:, other],
            gap_frames & available[:, other],
        )
        if shared.sum() >= min_shared and covered.sum() >= min_covered:
            training_frames, gap_frames = shared, covered
            chosen.append(int(other))
    if len(chosen) < RIGID_POINTS:
        return None
    order = _order_by_span(positions[training_frames][:, chosen])
    points = np.array(chosen)[order]
    return ReferenceMarkers(
        points, deviation[points], np.flatnonzero(training_frames), np.flatnonzero(gap_frames)
    )


def _distance_deviations(
    positions: Array, observed: Flags, available: Flags, point: int
) -> Array:
    """Return the standard deviation of each distance to the point, meters; infinite if
    unknown."""
    shared = observed[:, None] & available
    shared[:, point] = False
    count = shared.sum(axis=0)
    distances = np.linalg.norm(positions - positions[:, [point]], axis=2)
    distances = np.where(shared, distances, 0.0)
    mean = distances.sum(axis=0) / np.maximum(count, 1)
    variance = (np.where(shared, distances - mean, 0.0) ** 2).sum(axis=0) / np.maximum(count, 1)
    return np.where(count >= MIN_SHARED_FRACTION * observed.sum(), np.sqrt(variance), np.inf)


def _order_by_span(positions: Array) -> NDArray[np.intp]:
    """Move three markers that are not on a line to the front; keep the order of the others.

    Parameters
    ----------
    positions : shape (n_frames, n_references, 3)
    """
    order = list(range(positions.shape[1]))
    distances_to_first = np.linalg.norm(positions - positions[:, :1], axis=2).mean(axis=0)
    second = next(
        (index for index in order[1:] if distances_to_first[index] > MIN_DISTANCE_M), 1
    )
    line = positions[:, second] - positions[:, 0]
    length = np.maximum(np.linalg.norm(line, axis=1), 1e-9)
    offsets = positions - positions[:, :1]
    height = np.linalg.norm(np.cross(line[:, None], offsets), axis=2) / length[:, None]
    off_line = height.mean(axis=0)
    off_line[[0, second]] = 0.0
    third = next((index for index in order[1:] if off_line[index] > MIN_DISTANCE_M), None)
    third = int(np.argmax(off_line)) if third is None else third
    front = [0, second, third]
    return np.array(front + [index for index in order if index not in front])


def fit_rigid_frames(positions: Array, weights: Array) -> tuple[Array, Array]:
    """Fit a rigid shape to points in every frame (Kabsch 1976, doi:10.1107/S0567739476001873).

    The shape is the mean of the points; shape and frames are fitted alternately.

    Parameters
    ----------
    positions : shape (n_frames, n_points, 3), meters
    weights : shape (n_points,)

    Returns
    -------
    rotations : shape (n_frames, 3, 3)
        From the frame of the shape to the world.
    origins : shape (n_frames, 3), meters
    """
    weights = weights / weights.sum()
    origins = np.einsum("p,fpi->fi", weights, positions)
    offsets = positions - origins[:, None]
    shape = offsets[len(offsets) // 2]
    for _ in range(N_FITS):
        spread = np.einsum("p,fpi,pj->fij", weights, offsets, shape)
        rotations, _ = nearest_rotations(spread)
        shape = np.einsum("fij,fpi->pj", rotations, offsets) / len(offsets)
    return rotations, origins
