"""Canny edges of a depth image."""

import numpy as np
import scipy
from numpy.typing import NDArray

from ...arrays import Array, Integers

SMOOTHING_PX = 1.0
"""Standard deviation, pixels. Chosen by hand, as the paper gives no value."""
STRONG_STEP_M, WEAK_STEP_M = 0.10, 0.04
"""Hysteresis thresholds of the depth step, meters per pixel. Chosen by hand, as the paper gives
no value."""
_BACKGROUND_OFFSET_M = 1.0
"""Assumed distance of the background behind the actor. Chosen by hand, as the paper gives no
value."""
_SOBEL_GAIN = 8.0
"""Response of the Sobel operator to a slope of 1, a factor. By definition."""


def canny(image: Array, strong: float, weak: float) -> NDArray[np.bool_]:
    """Return the edges of an image (height, width) [CAN86]_.

    Non-maximum suppression thins the smoothed gradients. Hysteresis keeps weak edges that
    touch strong ones.

    Parameters
    ----------
    image : shape (height, width)
    strong, weak : float
        Thresholds of the slope, per pixel.

    References
    ----------
    .. [CAN86] Canny (1986). A computational approach to edge detection. IEEE Transactions on
       Pattern Analysis and Machine Intelligence 8(6).
    """
    smooth = scipy.ndimage.gaussian_filter(image, SMOOTHING_PX)
    across, down = (
        scipy.ndimage.sobel(smooth, axis=1) / _SOBEL_GAIN,
        scipy.ndimage.sobel(smooth, axis=0) / _SOBEL_GAIN,
    )
    slope = np.hypot(across, down)
    thinned_mask = (slope >= weak) & _is_local_maximum(slope, across, down)
    groups, n_groups = scipy.ndimage.label(thinned_mask, structure=np.ones((3, 3)))
    is_edge_group = np.zeros(n_groups + 1, dtype=bool)
    is_edge_group[groups[thinned_mask & (slope >= strong)]] = True
    is_edge_group[0] = False
    edges: NDArray[np.bool_] = is_edge_group[groups]
    return edges


def _is_local_maximum(slope: Array, across: Array, down: Array) -> NDArray[np.bool_]:
    """Return the mask of pixels without a steeper neighbor across the edge."""
    padded = np.pad(slope, 1)
    sector = np.rint(np.arctan2(down, across) / (np.pi / 4.0)).astype(int) % 4
    is_maximum = np.zeros(slope.shape, dtype=bool)
    for number, (row, column) in enumerate(((0, 1), (1, 1), (1, 0), (1, -1))):
        after = padded[1 + row: padded.shape[0] - 1 + row,
                       1 + column: padded.shape[1] - 1 + column]  # fmt: skip
        before = padded[1 - row: padded.shape[0] - 1 - row,
                        1 - column: padded.shape[1] - 1 - column]  # fmt: skip
        # On a plateau of two equal slopes one of them stays.
        is_maximum |= (sector == number) & (slope > after) & (slope >= before)
    return is_maximum


def edge_pixels(depth: Array, nearest: Integers | None = None) -> Integers:
    """Return the pixels of an actor at depth edges, shape (n,).

    As in [LOU12] section 3.4.2, an edge pixel on the background is replaced by the adjacent
    pixel of the actor, if there is one.

    Parameters
    ----------
    depth : shape (height, width), meters
        0 is background.
    nearest : int, shape (height * width,), optional
        The actor's pixel nearest to each pixel.
    """
    actor = depth > 0.0
    if not actor.any():
        return np.zeros(0, dtype=np.intp)
    edges = np.flatnonzero(
        canny(
            np.where(actor, depth, depth.max() + _BACKGROUND_OFFSET_M),
            STRONG_STEP_M,
            WEAK_STEP_M,
        )
    )
    width = depth.shape[1]
    if nearest is None:
        rows, columns = scipy.ndimage.distance_transform_edt(
            ~actor, return_distances=False, return_indices=True
        )
        nearest = (rows * width + columns).ravel().astype(np.intp)
    nearest_pixels: Integers = nearest[edges]
    is_adjacent = np.maximum(np.abs(nearest_pixels // width - edges // width),
                        np.abs(nearest_pixels % width - edges % width)) <= 1  # fmt: skip
    unique: Integers = np.unique(nearest_pixels[is_adjacent])
    return unique
