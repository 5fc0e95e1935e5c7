"""Features of depth pixels: the difference of depth at two places nearby.

The places are given in metres and divided by the pixel's depth, so that a feature sees the same
part of a body from near and far, and with any camera. Where nothing is seen, and outside of the
picture, the depth is `BACKGROUND_MM`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera

DepthImage = NDArray[np.float32]
BACKGROUND_MM = 10_000
"""Millimetres: how far away nothing is."""
MM_PER_M = 1000.0


class PixelFeatures(NamedTuple):
    """Pixels to be told, with what their features need."""

    pictures: NDArray[np.uint16]
    """Depth of all images, concatenated, millimetres; each has a border of `BACKGROUND_MM`."""
    place: NDArray[np.int32]
    """Index of each pixel in `pictures`, shape (n,)."""
    column: NDArray[np.float32]
    row: NDArray[np.float32]
    across: NDArray[np.float32]
    """Pixels per metre at the pixel's depth, to the right and down."""
    down: NDArray[np.float32]
    width: int
    """Of the pictures without their margin, pixels."""
    height: int

    def part(self, chosen: slice | NDArray[np.intp]) -> "PixelFeatures":
        """Return some of the pixels."""
        names = ("place", "column", "row", "across", "down")
        return self._replace(**{name: getattr(self, name)[chosen] for name in names})


def pad_depth_image(depth: DepthImage) -> NDArray[np.uint16]:
    """Return a depth image (height, width), metres, in millimetres with a background border."""
    told = np.full((depth.shape[0] + 2, depth.shape[1] + 2), BACKGROUND_MM, dtype=np.uint16)
    near = np.minimum(np.rint(depth * np.float32(MM_PER_M)), BACKGROUND_MM)
    told[1:-1, 1:-1] = np.where(depth > 0.0, near, BACKGROUND_MM)
    return told


def pixel_features(
    pictures: NDArray[np.uint16],
    number: NDArray[np.intp],
    rows: NDArray[np.intp],
    columns: NDArray[np.intp],
    camera: Camera,
) -> PixelFeatures:
    """Prepare pixels of pictures (n_pictures, height + 2, width + 2) of `pad_depth_image`.

    `number` tells in which picture each pixel is.
    """
    _, height, width = pictures.shape
    place = (number * height + rows + 1) * width + columns + 1
    flat = pictures.reshape(-1)
    depth = flat[place].astype(np.float32) / np.float32(MM_PER_M)
    return PixelFeatures(
        flat,
        place.astype(np.int32),
        columns.astype(np.float32),
        rows.astype(np.float32),
        np.float32(camera.fx) / depth,
        np.float32(camera.fy) / depth,
        width - 2,
        height - 2,
    )


def depth_differences(views: PixelFeatures, offsets: NDArray[np.float32]) -> NDArray[np.int32]:
    """Return depth at the first offset less that at the second, millimetres, shape (n,).

    Parameters
    ----------
    views : PixelViews
    offsets : shape (4,) or (4, n), metres
        To the right and down, of the first place and of the second.
    """
    first = _probed(views, offsets[0], offsets[1])
    return first - _probed(views, offsets[2], offsets[3])


def _probed(
    views: PixelFeatures, right: NDArray[np.float32], down: NDArray[np.float32]
) -> NDArray[np.int32]:
    """Depth, millimetres, this far from each pixel."""
    column = views.across * right
    column += views.column
    row = views.down * down
    row += views.row
    np.clip(column, -1.0, views.width, out=column)
    np.clip(row, -1.0, views.height, out=row)
    np.rint(column, out=column)
    np.rint(row, out=row)
    column -= views.column
    row -= views.row
    row *= np.float32(views.width + 2)
    row += column
    place = row.astype(np.int32)
    place += views.place
    return views.pictures[place].astype(np.int32)
