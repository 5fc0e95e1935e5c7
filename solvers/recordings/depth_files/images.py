"""Pictures of depth of which each is a PNG file of its own."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import ColorImage, DepthImage
from ...errors import InvalidFileError
from ..containers import is_listed, largest_color, listed_image

NONE = -1
"""Stands for a frame without a picture."""


@dataclass(frozen=True, eq=False)
class DepthImageFiles:
    """Reads the PNG file of a frame; to be `DepthRecording.read_depth`.

    Attributes
    ----------
    folder : Path
    names : tuple of str
        Files in it.
    frames : int array, shape (n_frames,)
        Which of the files each frame has; -1: none, and the frame is empty.
    shape : (int, int)
        Rows and columns.
    metres : float
        Metres in one unit of a pixel.
    confidence : tuple of str, or None
        Files with the confidence of each pixel, beside `names`.
    least : int
        Confidence below which a pixel is left out.
    """

    folder: Path
    names: tuple[str, ...]
    frames: NDArray[np.intp]
    shape: tuple[int, int]
    metres: float
    confidence: tuple[str, ...] | None = None
    least: int = 0

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, metres; 0: no reading."""
        number = self.frames[index]
        if number == NONE:
            return np.zeros(self.shape, np.float32)
        pixels = read_pixels(self.folder, self.names[number], self.shape)
        depth = (pixels * self.metres).astype(np.float32)
        if self.confidence is None or not self.least:
            return depth
        sure = read_pixels(self.folder, self.confidence[number], self.shape)
        return np.where(sure >= self.least, depth, np.float32(0.0))


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
        """Return the colours (height, width, 3) of a frame, 0 to 255."""
        number = self.frames[index]
        if number == NONE or not is_listed(self.folder, self.names[number]):
            return np.zeros((*self.shape, 3), np.uint8)
        largest = largest_color(self.shape)
        with listed_image(self.folder, self.names[number], largest) as image:
            return np.asarray(image.convert("RGB").resize(self.shape[::-1]), np.uint8)


def read_pixels(folder: Path, name: str, shape: tuple[int, int]) -> NDArray[np.int32]:
    """Return the numbers in a grey PNG file, which must have this shape, (height, width).

    Raises InvalidFileError where it has not, is missing or damaged, or not in the folder.
    """
    height, width = shape
    with listed_image(folder, name, (width, height), ("PNG",)) as image:
        pixels = np.asarray(image).astype(np.int32)
    if pixels.shape != shape:
        raise InvalidFileError(
            f"{folder / name} is not a gray image of {width} x {height} pixels any more. Copy"
            " it again."
        )
    return pixels
