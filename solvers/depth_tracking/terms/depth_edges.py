"""Edges of a picture of depth, by Canny's method."""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, gaussian_filter, label, sobel

Array = NDArray[np.float64]
Integers = NDArray[np.intp]

SMOOTHING = 1.0
"""Standard deviation, pixels."""
STRONG, WEAK = 0.10, 0.04
"""Metres per pixel: edges start where depth changes by the first, and go on by the second."""
_BEHIND = 1.0
"""How far behind the actor the background is taken to be, metres."""
_SOBEL = 8.0
"""What Sobel's operator answers to a slope of 1."""


def canny(picture: Array, strong: float, weak: float) -> NDArray[np.bool_]:
    """Return the edges of a picture (height, width) [CAN86]_.

    Smoothed slopes are thinned to where they are steepest across the edge; weak edges are kept
    where they touch strong ones.

    Parameters
    ----------
    picture : shape (height, width)
    strong, weak : float
        Thresholds of the slope, per pixel.

    References
    ----------
    .. [CAN86] Canny (1986). A computational approach to edge detection. IEEE Transactions on
       Pattern Analysis and Machine Intelligence 8(6).
    """
    smooth = gaussian_filter(picture, SMOOTHING)
    across, down = sobel(smooth, axis=1) / _SOBEL, sobel(smooth, axis=0) / _SOBEL
    slope = np.hypot(across, down)
    thin = (slope >= weak) & _steepest(slope, across, down)
    groups, n_groups = label(thin, structure=np.ones((3, 3)))
    kept = np.zeros(n_groups + 1, dtype=bool)
    kept[groups[thin & (slope >= strong)]] = True
    kept[0] = False
    edges: NDArray[np.bool_] = kept[groups]
    return edges


def _steepest(slope: Array, across: Array, down: Array) -> NDArray[np.bool_]:
    """Tell where no neighbour across the edge is steeper."""
    padded = np.pad(slope, 1)
    sector = np.rint(np.arctan2(down, across) / (np.pi / 4.0)).astype(int) % 4
    steepest = np.zeros(slope.shape, dtype=bool)
    for number, (row, column) in enumerate(((0, 1), (1, 1), (1, 0), (1, -1))):
        after = padded[1 + row: padded.shape[0] - 1 + row,
                       1 + column: padded.shape[1] - 1 + column]  # fmt: skip
        before = padded[1 - row: padded.shape[0] - 1 - row,
                        1 - column: padded.shape[1] - 1 - column]  # fmt: skip
        # On a plateau of two equal slopes one of them stays.
        steepest |= (sector == number) & (slope > after) & (slope >= before)
    return steepest


def edge_pixels(depth: Array, nearest: Integers | None = None) -> Integers:
    """Return the pixels of an actor that lie at edges of depth, shape (n,).

    As in [LOU12] section 3.4.2: where an edge falls on the background, the actor's pixel right
    beside it is taken, if there is one.

    Parameters
    ----------
    depth : shape (height, width), metres
        0 is background.
    nearest : int, shape (height * width,), optional
        The actor's pixel nearest to each pixel.
    """
    actor = depth > 0.0
    if not actor.any():
        return np.zeros(0, dtype=np.intp)
    edges = np.flatnonzero(canny(np.where(actor, depth, depth.max() + _BEHIND), STRONG, WEAK))
    width = depth.shape[1]
    if nearest is None:
        rows, columns = distance_transform_edt(
            ~actor, return_distances=False, return_indices=True
        )
        nearest = (rows * width + columns).ravel().astype(np.intp)
    found: Integers = nearest[edges]
    beside = np.maximum(np.abs(found // width - edges // width),
                        np.abs(found % width - edges % width)) <= 1  # fmt: skip
    unique: Integers = np.unique(found[beside])
    return unique
