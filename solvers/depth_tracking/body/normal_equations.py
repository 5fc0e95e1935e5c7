"""Sum up what terms ask of segments, and solve for the step of the coordinates."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .kinematics import N_SEGMENTS
from .tables import CAPSULE_SEGMENTS

Array = NDArray[np.float64]
Integers = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class SegmentEquations:
    """What a term asks of the twists of segments: minimise t'Mt/2 - m't, for each segment.

    Every row of a least-squares term about the surface of a segment has the form g'(w x p + v)
    with the segment's twist (w, v), so that a 6 x 6 matrix per segment holds all rows.

    Attributes
    ----------
    matrices : shape (17, 6, 6)
    vectors : shape (17, 6)
    cost : float
        Half the weighted sum of squares before the step.
    """

    matrices: Array
    vectors: Array
    cost: float


@dataclass(frozen=True, eq=False)
class PoseEquations:
    """What a prior asks of the coordinates: minimise d'Ad/2 - b'd for their change d."""

    matrix: Array
    """Shape (36, 36)."""
    vector: Array
    """Shape (36,)."""
    cost: float


class SurfaceRows(NamedTuple):
    """Rows of a least-squares term: how far points of the surface should move which way."""

    points: Array
    """Camera frame, shape (n, 3), metres."""
    directions: Array
    """Shape (n, 3); a direction's length scales its residual."""
    residuals: Array
    """What direction . (movement of the point) should be, shape (n,)."""
    weights: Array
    """Of the squares, shape (n,)."""
    capsules: Integers
    """Which capsule each point is on, shape (n,)."""


def rows_toward_targets(
    points: Array, targets: Array, weights: Array, capsules: Integers
) -> SurfaceRows:
    """Return the rows that ask points (n, 3) to move to targets (n, 3), three for each."""
    return SurfaceRows(
        np.repeat(points, 3, axis=0), np.tile(np.eye(3), (len(points), 1)),
        (targets - points).ravel(), np.repeat(weights, 3), np.repeat(capsules, 3),
    )  # fmt: skip


NO_ROWS = rows_toward_targets(
    np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.intp)
)
"""Of a term that has nothing to say."""


def concatenate_rows(rows: Sequence[SurfaceRows]) -> SurfaceRows:
    """Return the rows of several terms as one."""
    parts = zip(NO_ROWS, *rows, strict=True)
    return SurfaceRows(*(np.concatenate(part) for part in parts))


def segment_equations(rows: SurfaceRows) -> SegmentEquations:
    """Sum rows up, per segment."""
    segments = CAPSULE_SEGMENTS[rows.capsules]
    return equations_along_directions(
        rows.points, rows.directions, rows.residuals, rows.weights, segments
    )


def equations_along_directions(
    points: Array, directions: Array, residuals: Array, weights: Array, segments: Integers
) -> SegmentEquations:
    """Ask points on segments to move along directions; arrays as those of `SurfaceRows`."""
    lines = np.empty((len(points), 7))
    screw_rows(points, directions, out=lines[:, :6])
    lines[:, 6] = residuals
    lines *= np.sqrt(weights)[:, np.newaxis]
    # Sorted by segment, each one's sums are a product of two small matrices.
    order = np.argsort(segments.astype(np.int16), kind="stable")
    lines = lines[order]
    ends = np.cumsum(np.bincount(segments, minlength=N_SEGMENTS))
    sums = np.zeros((N_SEGMENTS, 7, 7))
    start = 0
    for segment, end in enumerate(ends):
        if end > start:
            block = lines[start:end]
            sums[segment] = block.T @ block
        start = end
    return SegmentEquations(sums[:, :6, :6], sums[:, :6, 6], 0.5 * float(sums[:, 6, 6].sum()))


def equations_toward_targets(
    points: Array, targets: Array, weights: Array, segments: Integers
) -> SegmentEquations:
    """Ask points (n, 3) on segments to move to targets (n, 3); `weights` are of the squares."""
    rows = rows_toward_targets(points, targets, weights, segments)
    return equations_along_directions(*rows)


def screw_rows(points: Array, directions: Array, out: Array | None = None) -> Array:
    """Return (point x direction, direction) (n, 6): what a twist is multiplied with."""
    found = np.empty((len(points), 6)) if out is None else out
    x, y, z = points.T
    u, v, w = directions.T
    found[:, 0], found[:, 1], found[:, 2] = y * w - z * v, z * u - x * w, x * v - y * u
    found[:, 3:] = directions
    return found


def equations_in_coordinates(
    equations: Iterable[SegmentEquations], twists: Array
) -> PoseEquations:
    """Add equations of segments up, and express them in the coordinates.

    Parameters
    ----------
    equations : iterable of SegmentEquations
    twists : shape (17, 6, 36)
        How the coordinates move the segments.
    """
    found = list(equations)
    matrices = np.sum([one.matrices for one in found], axis=0)
    vectors = np.sum([one.vectors for one in found], axis=0)
    flat = twists.reshape(6 * N_SEGMENTS, -1)
    pressed = (matrices @ twists).reshape(6 * N_SEGMENTS, -1)
    return PoseEquations(
        flat.T @ pressed, flat.T @ vectors.ravel(), sum(one.cost for one in found)
    )


def sum_equations(equations: Iterable[PoseEquations]) -> PoseEquations:
    """Return the sum of equations in the coordinates."""
    found = list(equations)
    return PoseEquations(
        np.sum([one.matrix for one in found], axis=0),
        np.sum([one.vector for one in found], axis=0),
        sum(one.cost for one in found),
    )


def solve_step(equations: PoseEquations, damping: Array) -> Array:
    """Return the change of the coordinates, with `damping` (36,) added to the diagonal."""
    change: Array = np.linalg.solve(equations.matrix + np.diag(damping), equations.vector)
    return change
