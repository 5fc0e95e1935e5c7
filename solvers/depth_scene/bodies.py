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
Points = NDArray[np.float64]

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
    depth : float array, shape (height, width), metres
        The picture.
    step : int
        Of the columns and rows, every so many were looked at.
    labels : int array, shape (-(-height // step), -(-width // step))
        0 nothing, 1 the body with the largest surface, 2 the next, and so on.
    areas : float array, shape (n,), square metres
        Seen surface of each, as if it faced the camera.
    middles : float array, shape (n, 3), metres
        Middle of each in the camera's frame.
    """

    depth: Depth
    step: int
    labels: NDArray[np.intp]
    areas: NDArray[np.float64]
    middles: NDArray[np.float64]

    def mask(self, label: int) -> Mask:
        """Return the pixels (height, width) of a body."""
        own = self.labels == label
        mask = np.zeros(self.depth.shape, dtype=bool)
        if self.step == 1 or not own.any():
            return own if self.step == 1 else mask
        rows, columns = (_around(own.any(axis=axis)) for axis in (1, 0))
        coarse = self.depth[:: self.step, :: self.step]
        place = tuple(
            slice(span.start * self.step, span.stop * self.step) for span in (rows, columns)
        )
        kept = np.where(own, coarse, 0.0)[rows, columns]
        mask[place] = _refined(self.depth[place], kept, self.step)
        return mask


def find_bodies(depth: Depth, camera: Camera, smallest: float) -> Bodies:
    """Divide what is seen into bodies of at least `smallest` square metres of surface.

    Neighbouring pixels belong together where their depths differ by no more than the noise of
    a camera. Smaller pieces come to the body that they are nearest to, or to none. Where much
    is seen, every second or third pixel is looked at, and the others follow.
    """
    few = int((depth > 0.0).sum()) <= MOST_SEEN
    step = 1 if few else -(-camera.width // COARSE_WIDTH)
    coarse, camera = depth[::step, ::step], camera.every(step)
    pieces, areas = _pieces(coarse, camera)
    points = _grouped(pieces, camera.back_project(coarse))
    large = np.flatnonzero(areas >= smallest)
    large = large[np.argsort(-areas[large], kind="stable")]
    places = np.zeros(len(areas) + 1, dtype=np.intp)
    for piece in large + 1:
        places[piece] = _whose_limb(piece, places, areas, points) or places.max() + 1
    _join_small_pieces(places, areas, points)
    n_bodies = int(places.max())
    surfaces = np.zeros(n_bodies + 1)
    np.add.at(surfaces, places[1:], areas)
    middles = [np.median(each, axis=0) for each in _bodies(places, points)]
    return Bodies(depth, step, places[pieces], surfaces[1:], np.array(middles).reshape(-1, 3))


def _grouped(pieces: NDArray[np.intp], points: Points) -> list[Points]:
    """Return the points of each piece, shape (n, 3), the first those of none."""
    order = np.argsort(pieces, axis=None, kind="stable")
    ends = np.cumsum(np.bincount(pieces.ravel()))[:-1]
    return np.split(points.reshape(-1, 3)[order], ends)


def _bodies(places: NDArray[np.intp], points: list[Points]) -> list[Points]:
    """Return the points of each body."""
    return [
        np.concatenate([points[piece] for piece in np.flatnonzero(places == place)])
        for place in range(1, int(places.max(initial=0)) + 1)
    ]


def _around(any_there: Mask) -> slice:
    """Return the span of what is there, and one more on both sides."""
    there = np.flatnonzero(any_there)
    return slice(max(int(there[0]) - 1, 0), min(int(there[-1]) + 2, len(any_there)))


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
    surfaces = _surface(depth, camera)[seen]
    areas = np.bincount(labels, weights=surfaces, minlength=n_pieces)
    return pieces, areas.astype(np.float64)


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
    piece: int, places: NDArray[np.intp], areas: NDArray[np.float64], points: list[Points]
) -> int:
    """Return which of the bodies so far a large piece is a limb of, 0 for none."""
    for other in np.flatnonzero(places):
        small = areas[piece - 1] <= LIMB * areas[other - 1]
        if small and _gap(points[piece], points[other][::FEW]) <= 0.0:
            return int(places[other])
    return 0


def _join_small_pieces(
    places: NDArray[np.intp], areas: NDArray[np.float64], points: list[Points]
) -> None:
    """Give small pieces to the body that they are beside, or that their middle is in reach of.

    `places` is which body each piece is, 0 for none, and is changed.
    """
    bodies = [body[::FEW] for body in _bodies(places, points)]
    for piece in np.flatnonzero(areas >= SMALLEST_PIECE) + 1:
        if places[piece] or not bodies:
            continue
        apart = [_out_of_reach(points[piece], body) for body in bodies]
        if min(apart) <= 0.0:
            places[piece] = int(np.argmin(apart)) + 1


def _out_of_reach(own: Points, body: Points) -> float:
    """Return how many metres a piece is out of reach of a body; it belongs to it below 0."""
    box = np.maximum(body.min(axis=0) - own.max(axis=0), own.min(axis=0) - body.max(axis=0))
    if box.max() > REACH:
        return float(box.max())
    to_middle = float(np.linalg.norm(body - np.median(own, axis=0), axis=-1).min())
    return min(to_middle - REACH, _gap(own, body))


def _gap(own: Points, body: Points) -> float:
    """Return how many metres more than `BESIDE` are between two sets of points."""
    few = own[:: max(1, len(own) // FEW)]
    return float(np.linalg.norm(few[:, np.newaxis] - body, axis=-1).min()) - BESIDE
