"""Features of depth pixels: the difference of depth at two offsets.

Offsets are in meters and divided by the depth of the pixel, so that a feature is independent of
distance and camera. Pixels without reading, and outside of the image, have the depth
`BACKGROUND_MM`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Single
from ...depth_scene import Camera

BACKGROUND_MM = 10_000
"""Depth of pixels without reading."""
MM_PER_M = 1000.0
"""Millimeters in a meter, by definition."""


class PixelFeatures(NamedTuple):
    """Pixels to classify, with the data that their features need."""

    images: NDArray[np.uint16]
    """Depth of all images, concatenated, millimeters; each has a border of `BACKGROUND_MM`."""
    flat_index: NDArray[np.int32]
    """Index of each pixel in `pictures`, shape (n,)."""
    column: NDArray[np.float32]
    row: NDArray[np.float32]
    across: NDArray[np.float32]
    """Pixels per meter at the pixel's depth, to the right and down."""
    down: NDArray[np.float32]
    width: int
    """Size of the images without their border, pixels."""
    height: int

    def select(self, chosen: slice | NDArray[np.intp]) -> "PixelFeatures":
        """Return some of the pixels."""
        names = ("flat_index", "column", "row", "across", "down")
        return self._replace(**{name: getattr(self, name)[chosen] for name in names})


def pad_depth_image(depth: Single) -> NDArray[np.uint16]:
    """Return a depth image (height, width), meters, in millimeters with a background border."""
    padded = np.full((depth.shape[0] + 2, depth.shape[1] + 2), BACKGROUND_MM, dtype=np.uint16)
    millimeters = np.minimum(np.rint(depth * np.float32(MM_PER_M)), BACKGROUND_MM)
    padded[1:-1, 1:-1] = np.where(depth > 0.0, millimeters, BACKGROUND_MM)
    return padded


def pixel_features(
    images: NDArray[np.uint16],
    image_index: NDArray[np.intp],
    rows: NDArray[np.intp],
    columns: NDArray[np.intp],
    camera: Camera,
) -> PixelFeatures:
    """Prepare pixels of images (n_images, height + 2, width + 2) from `pad_depth_image`.

    `image_index` is the image of each pixel.
    """
    _, height, width = images.shape
    index = (image_index * height + rows + 1) * width + columns + 1
    flat = images.reshape(-1)
    depth = flat[index].astype(np.float32) / np.float32(MM_PER_M)
    return PixelFeatures(
        flat,
        index.astype(np.int32),
        columns.astype(np.float32),
        rows.astype(np.float32),
        np.float32(camera.fx) / depth,
        np.float32(camera.fy) / depth,
        width - 2,
        height - 2,
    )


def depth_differences(views: PixelFeatures, offsets: NDArray[np.float32]) -> NDArray[np.int32]:
    """Return depth at the first offset less that at the second, millimeters, shape (n,).

    Parameters
    ----------
    views : PixelViews
    offsets : shape (4,) or (4, n), meters
        Right and down of the first offset, then of the second.
    """
    first = _depth_at_offset(views, offsets[0], offsets[1])
    return first - _depth_at_offset(views, offsets[2], offsets[3])


def _depth_at_offset(
    views: PixelFeatures, right: NDArray[np.float32], down: NDArray[np.float32]
) -> NDArray[np.int32]:
    """Return the depth, millimeters, at an offset from each pixel."""
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
    index = row.astype(np.int32)
    index += views.flat_index
    return views.images[index].astype(np.int32)
