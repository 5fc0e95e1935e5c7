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
LIMB, BESIDE = 0.4, 0.3
"""Share of a body up to which a piece is a limb of it, such as a leg behind the other, and
metres between the two."""
SMALLEST_PIECE = 1e-3
"""Square metres; what is smaller is noise."""
MOST_SEEN, COARSE_WIDTH = 20_000, 200
"""Pixels that are all connected; of more, every second or third, of a picture so wide."""
FEW = 12
"""Of the points of a body, every so many stands for it."""


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
    a camera. Smaller pieces come to the body that they are nearest to, or to none. Where much
    is seen, every second or third pixel is looked at, and the others follow.
    """
    if int((depth > 0.0).sum()) <= MOST_SEEN:
        return _found(depth, camera, smallest)
    step = -(-camera.width // COARSE_WIDTH)
    coarse = depth[::step, ::step]
    found = _found(coarse, camera.every(step), smallest)
    labels = np.zeros(depth.shape, dtype=np.intp)
    for place in range(len(found.areas), 0, -1):
        labels[_refined(depth, np.where(found.labels == place, coarse, 0.0), step)] = place
    return Bodies(labels, found.areas, found.middles)


def _found(depth: Depth, camera: Camera, smallest: float) -> Bodies:
    pieces, areas = _pieces(depth, camera)
    points = camera.back_project(depth)
    large = np.flatnonzero(areas >= smallest)
    large = large[np.argsort(-areas[large], kind="stable")]
    places = np.zeros(len(areas) + 1, dtype=np.intp)
    for piece in large + 1:
        places[piece] = _whose_limb(piece, places, pieces, areas, points) or places.max() + 1
    if len(large):
        _join_small_pieces(places, pieces, areas, points)
    labels = places[pieces]
    kept = [labels == place for place in range(1, places.max() + 1)]
    surfaces = _surface(depth, camera)
    return Bodies(
        labels,
        np.array([surfaces[mask].sum() for mask in kept]),
        np.array([np.median(points[mask], axis=0) for mask in kept]).reshape(-1, 3),
    )


def _refined(depth: Depth, coarse: Depth, step: int) -> Mask:
    """Return the pixels as far as those of a coarse body around them."""
    height, width = depth.shape
    mask = np.zeros(depth.shape, dtype=bool)
    around = np.pad(coarse, 1)
    rows, columns = coarse.shape
    for down in range(3):
        for right in range(3):
            shifted = around[down : down + rows, right : right + columns]
            near = shifted.repeat(step, axis=0).repeat(step, axis=1)[:height, :width]
            mask |= (near > 0.0) & (np.abs(depth - near) <= STEP + STEP_SQUARED * near**2)
    return mask & (depth > 0.0)


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


def _whose_limb(
    piece: int,
    places: NDArray[np.intp],
    pieces: NDArray[np.intp],
    areas: NDArray[np.float64],
    points: NDArray[np.float64],
) -> int:
    """Return which of the bodies so far a large piece is a limb of, 0 for none."""
    own = points[pieces == piece]
    for other in np.flatnonzero(places):
        if areas[piece - 1] > LIMB * areas[other - 1]:
            continue
        body = points[pieces == other][::FEW]
        if _gap(own, body) <= 0.0:
            return int(places[other])
    return 0


def _join_small_pieces(
    places: NDArray[np.intp],
    pieces: NDArray[np.intp],
    areas: NDArray[np.float64],
    points: NDArray[np.float64],
) -> None:
    """Give small pieces to the body that they are beside, or that their middle is in reach of.

    `places` is which body each piece is, 0 for none, and is changed.
    """
    labels = places[pieces]
    bodies = [points[labels == place][::FEW] for place in range(1, places.max() + 1)]
    for piece in np.flatnonzero(areas >= SMALLEST_PIECE) + 1:
        if places[piece]:
            continue
        own = points[pieces == piece]
        middle = np.median(own, axis=0)
        apart = [
            min(float(np.linalg.norm(body - middle, axis=-1).min()) - REACH, _gap(own, body))
            for body in bodies
        ]
        if min(apart) <= 0.0:
            places[piece] = int(np.argmin(apart)) + 1


def _gap(own: NDArray[np.float64], body: NDArray[np.float64]) -> float:
    """Return how many metres more than `BESIDE` are between two sets of points."""
    few = own[:: max(1, len(own) // FEW)]
    return float(np.linalg.norm(few[:, np.newaxis] - body, axis=-1).min()) - BESIDE
