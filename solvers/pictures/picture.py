"""Hold a finished picture, independent of the library that drew it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..files import write_atomically


@dataclass(frozen=True, eq=False)
class Picture:
    """Red, green and blue of every pixel.

    Attributes
    ----------
    pixels : uint8 array, shape (height, width, 3)
    """

    pixels: NDArray[np.uint8]

    def save(self, path: Path | str) -> None:
        """Write a PNG file atomically."""
        from PIL import Image

        with write_atomically(path) as part:
            Image.fromarray(self.pixels).save(part, format="PNG", optimize=True)


def stack_pictures(pictures: Sequence[Picture]) -> Picture:
    """Return the pictures one below the other, padded with white on the right."""
    width = max(picture.pixels.shape[1] for picture in pictures)
    rows = [
        np.pad(
            picture.pixels,
            ((0, 0), (0, width - picture.pixels.shape[1]), (0, 0)),
            constant_values=255,
        )
        for picture in pictures
    ]
    return Picture(np.concatenate(rows))
