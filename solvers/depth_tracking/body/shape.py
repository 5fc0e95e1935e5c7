"""How the surface of a body moves when its lengths and radii change."""

import numpy as np
from numpy.typing import NDArray

from .kinematics import N_SEGMENTS
from .model import BodyModel
from .normal_equations import Integers, SurfaceRows
from .tables import (
    CAPSULE_ENDS,
    CAPSULE_ROWS,
    CAPSULE_SEGMENTS,
    CAPSULES,
    LENGTHS,
    OFFSETS,
    PARENTS,
    SIDES,
)

Array = NDArray[np.float64]


def _without_side(name: str) -> str:
    for side in SIDES:
        if name.startswith(side):
            return name.removeprefix(side)
    return name


def _shared(names: list[str]) -> tuple[tuple[str, ...], Array]:
    """Return the different names, and which of them each one is, as rows of 0 and 1."""
    different = tuple(dict.fromkeys(names))
    return different, np.eye(len(different))[[different.index(name) for name in names]]


def _radius_names() -> list[str]:
    names = []
    for row in CAPSULE_ROWS:
        name = _without_side(row.name)
        round_one = row.radii[0] == row.radii[1]
        names += [f"{name}Radius"] * 2 if round_one else [f"{name}Width", f"{name}Depth"]
    return names


_LENGTHS, _LENGTH_SHARES = _shared([_without_side(name) for name in LENGTHS])
_RADII, _RADIUS_SHARES = _shared(_radius_names())
MEASURES = (*_LENGTHS, *_RADII)
"""Lengths and radii of a body whose left and right are the same: what may be refined."""
N_LENGTHS = len(_LENGTHS)


def resize_body(body: BodyModel, change: Array) -> BodyModel:
    """Return the body with each of its `MEASURES` made larger by a factor exp(change)."""
    lengths = body.lengths * np.exp(_LENGTH_SHARES @ change[:N_LENGTHS])
    factors = np.exp(_RADIUS_SHARES @ change[N_LENGTHS:])
    return BodyModel(lengths, body.radii * factors.reshape(len(CAPSULES), 2))


def shape_jacobian(body: BodyModel, frames: Array, rows: SurfaceRows) -> Array:
    """Return how each row's point moves along its direction when a measure grows.

    To first order, and with the directions of capsules kept.

    Parameters
    ----------
    body : BodyModel
    frames : shape (17, 4, 4)
        Its segments in the pose of the rows.
    rows : SurfaceRows

    Returns
    -------
    array, shape (n, n_measures)
        Per unit of the logarithm of each of `MEASURES`.
    """
    segments = CAPSULE_SEGMENTS[rows.capsules]
    rotations = frames[segments, :3, :3]
    directions = np.einsum("nji,nj->ni", rotations, rows.directions)
    along, out = _places(body, frames, rows.points, rows.capsules)
    starts, stops = CAPSULE_ENDS[rows.capsules].swapaxes(0, 1)
    by_length = np.einsum("ni,nil->nl", rows.directions, _origin_slopes(frames)[segments])
    by_length += (1.0 - along)[:, np.newaxis] * np.einsum("ni,nil->nl", directions, starts)
    by_length += along[:, np.newaxis] * np.einsum("ni,nil->nl", directions, stops)
    outward = directions * out
    by_radius = np.zeros((len(along), len(CAPSULES), 2))
    each = np.arange(len(along))
    by_radius[each, rows.capsules, 0] = outward[:, 0]
    by_radius[each, rows.capsules, 1] = outward[:, 1] + outward[:, 2]
    lengths = (by_length * body.lengths) @ _LENGTH_SHARES
    radii = (by_radius * body.radii).reshape(len(along), 2 * len(CAPSULES)) @ _RADIUS_SHARES
    return np.concatenate([lengths, radii], axis=1)


def _origin_slopes(frames: Array) -> Array:
    """Return how joints move when lengths grow, shape (17, 3, n_lengths), camera frame."""
    slopes = np.zeros((N_SEGMENTS, 3, len(LENGTHS)))
    for segment, parent in enumerate(PARENTS[1:], start=1):
        slopes[segment] = slopes[parent] + frames[parent, :3, :3] @ OFFSETS[segment]
    return slopes


def _places(
    body: BodyModel, frames: Array, points: Array, capsules: Integers
) -> tuple[Array, Array]:
    """Return where points are on capsules: how far along (0 to 1), and which way out.

    The second is of length 1 in the capsule's stretched frame, shape (n, 3).
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
