"""Read depth images of one size that are stored consecutively in a file."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import ColorImage, DepthImage
from ...errors import InvalidFileError
from ..containers import StoredBytes

MAX_PIXELS = 4096
"""Maximum plausible columns or rows of an image."""


@dataclass(frozen=True)
class DepthStack:
    """Read a depth image; serves as `DepthRecording.read_depth`.

    Attributes
    ----------
    content : StoredBytes
        From the first pixel of the first image.
    kind : str
        NumPy type of a pixel.
    shape : (int, int)
        Rows and columns.
    meters : float
        Meters per unit of a pixel.
    by_column : bool
        Whether pixels are in column-major order, as MATLAB writes them.
    mirrored : bool
        Whether columns are stored from right to left.
    """

    content: StoredBytes
    kind: str
    shape: tuple[int, int]
    meters: float
    by_column: bool = False
    mirrored: bool = False

    @property
    def frame_bytes(self) -> int:
        """Bytes of one image."""
        return self.shape[0] * self.shape[1] * np.dtype(self.kind).itemsize

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, meters; 0: no reading."""
        size = self.frame_bytes
        pixels = np.frombuffer(self.content.read(index * size, size), self.kind)
        image = pixels.reshape(self.shape, order="F" if self.by_column else "C")
        if self.mirrored:
            image = image[:, ::-1]
        with np.errstate(invalid="ignore", over="ignore"):  # damaged or very large floats
            return np.ascontiguousarray(image * self.meters, dtype=np.float32)


@dataclass(frozen=True)
class ColorStack:
    """Read color aligned with the depth pixels; serves as `DepthRecording.read_color`."""

    content: StoredBytes
    shape: tuple[int, int]

    def __call__(self, index: int) -> ColorImage:
        """Return the colors (height, width, 3) of a frame."""
        size = self.shape[0] * self.shape[1] * 3
        pixels = np.frombuffer(self.content.read(index * size, size), np.uint8)
        image: NDArray[np.uint8] = pixels.reshape(*self.shape, 3)
        return image


def check_size(path: Path | str, height: int, width: int) -> None:
    """Raise InvalidFileError unless the size of an image is plausible."""
    if not (1 < height <= MAX_PIXELS and 1 < width <= MAX_PIXELS):
        raise InvalidFileError(
            f"{path} has images of {width} x {height} pixels, which no depth camera makes."
            f" Width and height must be 2 to {MAX_PIXELS}."
        )
