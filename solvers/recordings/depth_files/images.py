"""Read depth and color images that are single files."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import ColorImage, DepthImage
from ...errors import InvalidFileError
from ..containers import is_listed, max_color_size, open_listed_image

NO_IMAGE = -1
"""Index of a frame without an image."""


@dataclass(frozen=True, eq=False)
class DepthImageFiles:
    """Read the PNG file of a frame; serves as `DepthRecording.read_depth`.

    Attributes
    ----------
    folder : Path
    names : tuple of str
        Files in the folder.
    frames : int array, shape (n_frames,)
        Index of the file of each frame; -1: none, and the frame is empty.
    shape : (int, int)
        Rows and columns.
    meters : float
        Meters per unit of a pixel.
    confidence : tuple of str, or None
        Files with the confidence of each pixel, parallel to `names`.
    min_confidence : int
        Confidence below which a pixel is ignored.
    """

    folder: Path
    names: tuple[str, ...]
    frames: NDArray[np.intp]
    shape: tuple[int, int]
    meters: float
    confidence: tuple[str, ...] | None = None
    min_confidence: int = 0

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, meters; 0: no reading."""
        number = self.frames[index]
        if number == NO_IMAGE:
            return np.zeros(self.shape, np.float32)
        pixels = read_pixels(self.folder, self.names[number], self.shape)
        depth = (pixels * self.meters).astype(np.float32)
        if self.confidence is None or not self.min_confidence:
            return depth
        confidence_pixels = read_pixels(self.folder, self.confidence[number], self.shape)
        return np.where(confidence_pixels >= self.min_confidence, depth, np.float32(0.0))


@dataclass(frozen=True, eq=False)
class ColorImageFiles:
    """Read the color image of a frame; serves as `DepthRecording.read_color`.

    `names` and `frames` are as in `DepthImageFiles`. An image of another size is resized to the
    size of the depth image; a missing one is black.
    """

    folder: Path
    names: tuple[str, ...]
    frames: NDArray[np.intp]
    shape: tuple[int, int]

    def __call__(self, index: int) -> ColorImage:
        """Return the colors (height, width, 3) of a frame, 0 to 255."""
        number = self.frames[index]
        if number == NO_IMAGE or not is_listed(self.folder, self.names[number]):
            return np.zeros((*self.shape, 3), np.uint8)
        max_size = max_color_size(self.shape)
        with open_listed_image(self.folder, self.names[number], max_size) as image:
            return np.asarray(image.convert("RGB").resize(self.shape[::-1]), np.uint8)


def read_pixels(folder: Path, name: str, shape: tuple[int, int]) -> NDArray[np.int32]:
    """Return the values of a gray PNG file of this shape, (height, width).

    Raises InvalidFileError if its shape differs, or if it is missing, damaged or outside the
    folder.
    """
    height, width = shape
    with open_listed_image(folder, name, (width, height), ("PNG",)) as image:
        pixels = np.asarray(image).astype(np.int32)
    if pixels.shape != shape:
        raise InvalidFileError(
            f"{folder / name} is no longer a gray image of {width} x {height} pixels. Copy it"
            " again."
        )
    return pixels
