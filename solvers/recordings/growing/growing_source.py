"""What is read of a depth recording while it grows: images as they are finished."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from ...depth_scene import Camera, DepthImage
from ..conventions import common_rate
from .image_names import PositionKind

MAX_GAP_STEPS = 10
"""Number of frames between two time stamps from which a clock has jumped. It guards the frame
rate of recordings whose clock jumps at the start (`test_rate_of_stamps_that_jump`)."""


class NewImage(NamedTuple):
    """A finished image; its depth is read by `GrowingDepth.read`."""

    name: str
    """Of its file; of a file with many images, its number."""
    position: float
    """Number or time stamp, see `PositionKind`."""
    written: float
    """Time at which it was written, seconds since 1970."""


class ImagePositions(NamedTuple):
    """Frame rate of a recording and the time of its images, from their positions."""

    frame_rate: float
    """Hertz."""
    seconds_per_unit: float
    """0 if positions say only the order: then images follow each other at the frame rate."""


class GrowingDepth(Protocol):
    """A depth recording that grows."""

    camera: Camera | None
    """None until the first image is there."""

    @property
    def is_gone(self) -> bool:
        """Whether it was removed or cut off, so that nothing can follow."""

    @property
    def issue(self) -> str:
        """Why no image was found yet, in a sentence or two."""

    def poll(self) -> list[NewImage]:
        """Return the images that were finished since the last call, in their order.

        Raises
        ------
        InvalidFileError
            The first image is no depth, or the camera or the scale is unknown.
        """

    def read(self, image: NewImage) -> DepthImage | None:
        """Return the depth of an image, meters; None if it is damaged or was removed."""

    def positions(self, positions: Sequence[float]) -> ImagePositions:
        """Return the rate of a recording from the positions of its first images."""

    def remarks(self) -> tuple[str, ...]:
        """Return a sentence on each kind of image that was left out."""


def measure_positions(
    kind: PositionKind, positions: Sequence[float], frame_rate: float
) -> ImagePositions:
    """Return the rate of images with these positions; `frame_rate` in Hz for images in order.

    Numbers with equal steps, such as every second one, count the frames between them. Time
    stamps may be rounded, have gaps, and jump.
    """
    steps = np.diff(positions)
    step = float(np.median(steps)) if len(steps) else 0.0
    if kind is PositionKind.TIMES and step > 0.0:
        n_steps = np.round(steps / step)
        is_near = (n_steps >= 1.0) & (n_steps <= MAX_GAP_STEPS)
        rate = float(n_steps[is_near].sum() / steps[is_near].sum())
        return ImagePositions(common_rate(rate), 1.0)
    if kind is PositionKind.NUMBERS:
        return ImagePositions(frame_rate, 1.0 / (max(step, 1.0) * frame_rate))
    return ImagePositions(frame_rate, 0.0)
