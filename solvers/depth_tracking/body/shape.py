"""Derivatives of the body surface by its lengths and radii."""

import numpy as np

from ...arrays import Array, Integers
from ...motion.humanoid import SIDES
from .model import MAX_LENGTH_M, MIN_LENGTH_M, BodyModel
from .normal_equations import SurfaceRows
from .segment_kinematics import N_SEGMENTS
from .tables import (
    CAPSULE_ENDS,
    CAPSULE_ROWS,
    CAPSULE_SEGMENTS,
    CAPSULES,
    LENGTHS,
    OFFSETS,
    PARENTS,
)


def _without_side(name: str) -> str:
    for side in SIDES:
        if name.startswith(side):
            return name.removeprefix(side)
    return name


def _unique_names(names: list[str]) -> tuple[tuple[str, ...], Array]:
    """Return the unique names, and the one-hot rows that select them."""
    unique = tuple(dict.fromkeys(names))
    return unique, np.eye(len(unique))[[unique.index(name) for name in names]]


def _radius_names() -> list[str]:
    names = []
    for row in CAPSULE_ROWS:
        name = _without_side(row.name)
        is_round = row.radii[0] == row.radii[1]
        names += [f"{name}Radius"] * 2 if is_round else [f"{name}Width", f"{name}Depth"]
    return names


_LENGTHS, _LENGTH_MAP = _unique_names([_without_side(name) for name in LENGTHS])
_RADII, _RADIUS_MAP = _unique_names(_radius_names())
MEASURES = (*_LENGTHS, *_RADII)
"""Lengths and radii of a symmetric body: the refined parameters."""
N_LENGTHS = len(_LENGTHS)


def resize_body(body: BodyModel, change: Array) -> BodyModel:
    """Return the body with its `MEASURES` scaled by exp(change), (n,), within bounds."""
    lengths = body.lengths * np.exp(_LENGTH_MAP @ change[:N_LENGTHS])
    radius_factors = np.exp(_RADIUS_MAP @ change[N_LENGTHS:])
    radii = body.radii * radius_factors.reshape(len(CAPSULES), 2)
    return BodyModel(*(np.clip(each, MIN_LENGTH_M, MAX_LENGTH_M) for each in (lengths, radii)))


def shape_jacobian(body: BodyModel, frames: Array, rows: SurfaceRows) -> Array:
    """Return the derivative of each row's point along its direction by the measures.

    First order, with constant capsule directions.

    Parameters
    ----------
    body : BodyModel
    frames : shape (17, 4, 4)
        Segment transforms in the pose of the rows.
    rows : SurfaceRows

    Returns
    -------
    array, shape (n, n_measures)
        Per unit of the logarithm of each of `MEASURES`.
    """
    segments = CAPSULE_SEGMENTS[rows.capsules]
    rotations = frames[segments, :3, :3]
    directions = np.einsum("nji,nj->ni", rotations, rows.directions)
    along, out = _surface_coordinates(body, frames, rows.points, rows.capsules)
    starts, stops = CAPSULE_ENDS[rows.capsules].swapaxes(0, 1)
    by_length = np.einsum("ni,nil->nl", rows.directions, _origin_derivatives(frames)[segments])
    by_length += (1.0 - along)[:, np.newaxis] * np.einsum("ni,nil->nl", directions, starts)
    by_length += along[:, np.newaxis] * np.einsum("ni,nil->nl", directions, stops)
    outward = directions * out
    by_radius = np.zeros((len(along), len(CAPSULES), 2))
    each = np.arange(len(along))
    by_radius[each, rows.capsules, 0] = outward[:, 0]
    by_radius[each, rows.capsules, 1] = outward[:, 1] + outward[:, 2]
    lengths = (by_length * body.lengths) @ _LENGTH_MAP
    radii = (by_radius * body.radii).reshape(len(along), 2 * len(CAPSULES)) @ _RADIUS_MAP
    return np.concatenate([lengths, radii], axis=1)


def _origin_derivatives(frames: Array) -> Array:
    """Return the derivatives of joints by lengths, (17, 3, n_lengths), camera frame."""
    derivatives = np.zeros((N_SEGMENTS, 3, len(LENGTHS)))
    for segment, parent in enumerate(PARENTS[1:], start=1):
        derivatives[segment] = derivatives[parent] + frames[parent, :3, :3] @ OFFSETS[segment]
    return derivatives


def _surface_coordinates(
    body: BodyModel, frames: Array, points: Array, capsules: Integers
) -> tuple[Array, Array]:
    """Return axis position (0 to 1) and outward direction of points on capsules.

    Directions (n, 3) are unit vectors in the capsule's scaled frame.
    """
    frame = frames[CAPSULE_SEGMENTS[capsules]]
    scales = 1.0 / body.radii[capsules][:, [0, 1, 1]]
    local = np.einsum("nji,nj->ni", frame[:, :3, :3], points - frame[:, :3, 3]) * scales
    starts, stops = (body.capsule_ends[capsules] * scales[:, np.newaxis]).swapaxes(0, 1)
    axis = stops - starts
    along = np.einsum("ni,ni->n", local - starts, axis) / (axis**2).sum(axis=1)
    along = np.clip(along, 0.0, 1.0)
    out = local - starts - along[:, np.newaxis] * axis
    size = np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-12)
    return along, out / size
