"""Bodies in a picture of depth: what hangs together in space, and not only in the picture."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from .camera import Camera

Mask = NDArray[np.bool_]
Depth = NDArray[np.floating[Any]]

STEP, STEP_SQUARED = 0.05, 0.005
"""Metres in depth, and metres per square metre of distance, between pixels of one surface."""
REACH = 0.5
"""Metres up to which smaller pieces, such as a hand held forward, belong to a body."""
SMALLEST_PIECE = 1e-3
"""Square metres; what is smaller is noise."""


@dataclass(frozen=True, eq=False)
class Bodies:
    """What stands in a picture.

    Attributes
    ----------
    labels : int array, shape (height, width)
        0 nothing, 1 the body with the largest surface, 2 the next, and so on.
    areas : float array, shape (n,), square metres
        Seen surface of each, as if it faced the camera.
    middles : float array, shape (n, 3), metres
        Middle of each in the camera's frame.
    """

    labels: NDArray[np.intp]
    areas: NDArray[np.float64]
    middles: NDArray[np.float64]


def find_bodies(depth: Depth, camera: Camera, smallest: float) -> Bodies:
    """Divide what is seen into bodies of at least `smallest` square metres of surface.

    Neighbouring pixels belong together where their depths differ by no more than the noise of
    a camera. Smaller pieces come to the body that they are nearest to, or to none.
    """
    pieces, areas = _pieces(depth, camera)
    points = camera.back_project(depth)
    large = np.flatnonzero(areas >= smallest)
    large = large[np.argsort(-areas[large], kind="stable")]
    labels = np.zeros(depth.shape, dtype=np.intp)
    for place, piece in enumerate(large, start=1):
        labels[pieces == piece + 1] = place
    _join_small_pieces(labels, pieces, areas, points)
    kept = [labels == place for place in range(1, len(large) + 1)]
    surfaces = _surface(depth, camera)
    return Bodies(
        labels,
        np.array([surfaces[mask].sum() for mask in kept]),
        np.array([np.median(points[mask], axis=0) for mask in kept]).reshape(-1, 3),
    )


def _pieces(depth: Depth, camera: Camera) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Label connected pixels from 1 on (0: nothing seen), and measure each piece's surface."""
    seen = depth > 0.0
    numbers = np.full(depth.shape, -1)
    numbers[seen] = np.arange(seen.sum())
    links = [_links(numbers, depth, axis) for axis in (0, 1)]
    one, other = np.concatenate(links, axis=1)
    n = int(seen.sum())
    graph = coo_array((np.ones(len(one), dtype=bool), (one, other)), shape=(n, n))
    n_pieces, labels = connected_components(graph, directed=False)
    pieces = np.zeros(depth.shape, dtype=np.intp)
    pieces[seen] = labels + 1
    areas = np.zeros(n_pieces)
    np.add.at(areas, labels, _surface(depth, camera)[seen])
    return pieces, areas


def _links(numbers: NDArray[Any], depth: Depth, axis: int) -> NDArray[Any]:
    """Return the numbers of neighbours on one surface, shape (2, n)."""
    length = depth.shape[axis]
    first, second = (
        np.take(depth, range(start, start + length - 1), axis=axis) for start in (0, 1)
    )
    near = np.minimum(first, second)
    linked = (near > 0.0) & (np.abs(first - second) <= STEP + STEP_SQUARED * near**2)
    ends = (np.take(numbers, range(start, start + length - 1), axis=axis) for start in (0, 1))
    return np.stack([end[linked] for end in ends])


def _surface(depth: Depth, camera: Camera) -> NDArray[np.float64]:
    """Return the square metres of each pixel, as if they faced the camera."""
    return np.asarray(depth, dtype=np.float64) ** 2 / (camera.fx * camera.fy)


def _join_small_pieces(
    labels: NDArray[np.intp],
    pieces: NDArray[np.intp],
    areas: NDArray[np.float64],
    points: NDArray[np.float64],
) -> None:
    """Give small pieces to the body within reach that is nearest to their middle."""
    bodies = [points[labels == place] for place in range(1, labels.max(initial=0) + 1)]
    if not bodies:
        return
    small = np.setdiff1d(
        np.flatnonzero(areas >= SMALLEST_PIECE) + 1, np.unique(pieces[labels > 0])
    )
    for piece in small:
        mask = pieces == piece
        middle = np.median(points[mask], axis=0)
        apart = [np.linalg.norm(body - middle, axis=-1).min() for body in bodies]
        if min(apart) <= REACH:
            labels[mask] = int(np.argmin(apart)) + 1
