"""Pictures of depth that stand one after the other in a file, all of one size."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import ColorImage, DepthImage
from ...errors import InvalidFileError
from ..containers import StoredBytes

MILLIMETER = 0.001
MAX_PIXELS = 4096
"""Columns or rows of the largest picture that is believed."""


@dataclass(frozen=True)
class DepthStack:
    """Reads a picture of depth; to be `DepthRecording.read_depth`.

    Attributes
    ----------
    content : StoredBytes
        From the first picture's first pixel on.
    kind : str
        NumPy's name of the type of one pixel.
    shape : (int, int)
        Rows and columns.
    metres : float
        Metres in one unit of a pixel.
    by_column : bool
        Whether pixels of a column follow each other, as MATLAB writes them.
    mirrored : bool
        Whether the columns stand from right to left.
    """

    content: StoredBytes
    kind: str
    shape: tuple[int, int]
    metres: float
    by_column: bool = False
    mirrored: bool = False

    @property
    def frame_bytes(self) -> int:
        """Bytes of one picture."""
        return self.shape[0] * self.shape[1] * np.dtype(self.kind).itemsize

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, metres; 0: no reading."""
        size = self.frame_bytes
        pixels = np.frombuffer(self.content.read(index * size, size), self.kind)
        picture = pixels.reshape(self.shape, order="F" if self.by_column else "C")
        if self.mirrored:
            picture = picture[:, ::-1]
        with np.errstate(invalid="ignore", over="ignore"):  # of damaged or very large floats
            return np.ascontiguousarray(picture * self.metres, dtype=np.float32)


@dataclass(frozen=True)
class ColorStack:
    """Reads the colours that pixels of depth see; to be `DepthRecording.read_color`."""

    content: StoredBytes
    shape: tuple[int, int]

    def __call__(self, index: int) -> ColorImage:
        """Return the colours (height, width, 3) of a frame."""
        size = self.shape[0] * self.shape[1] * 3
        pixels = np.frombuffer(self.content.read(index * size, size), np.uint8)
        picture: NDArray[np.uint8] = pixels.reshape(*self.shape, 3)
        return picture


def check_size(path: Path | str, height: int, width: int) -> None:
    """Raise InvalidFileError unless a picture can have so many rows and columns."""
    if not (1 < height <= MAX_PIXELS and 1 < width <= MAX_PIXELS):
        raise InvalidFileError(
            f"{path} has pictures of {width} x {height} pixels, which no depth camera makes."
            f" They may be 2 to {MAX_PIXELS} wide and high."
        )
