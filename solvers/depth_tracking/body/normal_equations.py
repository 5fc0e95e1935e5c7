"""Assemble the normal equations of segments and coordinates, and solve for the step."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Integers
from .segment_kinematics import N_SEGMENTS
from .tables import CAPSULE_SEGMENTS


@dataclass(frozen=True, eq=False)
class SegmentEquations:
    """Normal equations of segment twists: minimize t'Mt/2 - m't for each segment.

    Every row of a least-squares term about the surface of a segment has the form g'(w x p + v)
    with the segment's twist (w, v), so a 6 x 6 matrix per segment represents all rows.

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
    """Normal equations of the coordinates: minimize d'Ad/2 - b'd for their change d."""

    matrix: Array
    """Shape (36, 36)."""
    vector: Array
    """Shape (36,)."""
    cost: float


class SurfaceRows(NamedTuple):
    """Rows of a least-squares term: displacements of surface points along directions."""

    points: Array
    """Camera frame, shape (n, 3), meters."""
    directions: Array
    """Shape (n, 3); a direction's length scales its residual."""
    residuals: Array
    """Target values of direction . (movement of the point), shape (n,)."""
    weights: Array
    """Weights of the squares, shape (n,)."""
    capsules: Integers
    """Capsule of each point, shape (n,)."""


def rows_toward_targets(
    points: Array, targets: Array, weights: Array, capsules: Integers
) -> SurfaceRows:
    """Return rows that pull points (n, 3) to targets (n, 3), three for each point."""
    return SurfaceRows(
        np.repeat(points, 3, axis=0), np.tile(np.eye(3), (len(points), 1)),
        (targets - points).ravel(), np.repeat(weights, 3), np.repeat(capsules, 3),
    )  # fmt: skip


NO_ROWS = rows_toward_targets(
    np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.intp)
)
"""Rows of a term without residuals."""


def concatenate_rows(rows: Sequence[SurfaceRows]) -> SurfaceRows:
    """Concatenate the rows of several terms."""
    columns = zip(NO_ROWS, *rows, strict=True)
    return SurfaceRows(*(np.concatenate(column) for column in columns))


def segment_equations(rows: SurfaceRows) -> SegmentEquations:
    """Return the normal equations of rows, summed per segment."""
    segments = CAPSULE_SEGMENTS[rows.capsules]
    return equations_along_directions(
        rows.points, rows.directions, rows.residuals, rows.weights, segments
    )


def equations_along_directions(
    points: Array, directions: Array, residuals: Array, weights: Array, segments: Integers
) -> SegmentEquations:
    """Return equations that move points along directions; arrays as in `SurfaceRows`."""
    lines = np.empty((len(points), 7))
    screw_rows(points, directions, out=lines[:, :6])
    lines[:, 6] = residuals
    lines *= np.sqrt(weights)[:, np.newaxis]
    # After sorting by segment, each sum is a product of two small matrices.
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
    """Return equations that pull points (n, 3) to targets (n, 3); weights of the squares."""
    rows = rows_toward_targets(points, targets, weights, segments)
    return equations_along_directions(*rows)


def screw_rows(points: Array, directions: Array, out: Array | None = None) -> Array:
    """Return (point x direction, direction), shape (n, 6), the factors of a twist."""
    rows = np.empty((len(points), 6)) if out is None else out
    x, y, z = points.T
    u, v, w = directions.T
    rows[:, 0], rows[:, 1], rows[:, 2] = y * w - z * v, z * u - x * w, x * v - y * u
    rows[:, 3:] = directions
    return rows


def equations_in_coordinates(
    equations: Iterable[SegmentEquations], twists: Array
) -> PoseEquations:
    """Sum equations of segments and transform them to the coordinates.

    Parameters
    ----------
    equations : iterable of SegmentEquations
    twists : shape (17, 6, 36)
        Derivatives of the segments by the coordinates.
    """
    terms = list(equations)
    matrices = np.sum([term.matrices for term in terms], axis=0)
    vectors = np.sum([term.vectors for term in terms], axis=0)
    flat = twists.reshape(6 * N_SEGMENTS, -1)
    weighted = (matrices @ twists).reshape(6 * N_SEGMENTS, -1)
    return PoseEquations(
        flat.T @ weighted, flat.T @ vectors.ravel(), sum(term.cost for term in terms)
    )


def sum_equations(equations: Iterable[PoseEquations]) -> PoseEquations:
    """Return the sum of equations in the coordinates."""
    terms = list(equations)
    return PoseEquations(
        np.sum([term.matrix for term in terms], axis=0),
        np.sum([term.vector for term in terms], axis=0),
        sum(term.cost for term in terms),
    )


def solve_step(equations: PoseEquations, damping: Array) -> Array:
    """Return the change of the coordinates, with `damping` (36,) added to the diagonal."""
    change: Array = np.linalg.solve(equations.matrix + np.diag(damping), equations.vector)
    return change
