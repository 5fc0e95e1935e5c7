"""A depth recording: one depth image per frame, read on demand."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion.skeletons import check_frame_rate
from .camera import Camera

DepthImage = NDArray[np.float32]
ColorImage = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class DepthRecording:
    """Depth images of one camera, read from storage on demand.

    Attributes
    ----------
    camera : Camera
    n_frames : int
    frame_rate : float, hertz
    read_depth : callable
        Maps a frame to its depth, shape (height, width), meters along the optical axis.
        0 means no reading.
    read_color : callable, or None
        Maps a frame to the colors aligned with the depth pixels, shape (height, width, 3),
        0 to 255. None if no aligned color was recorded.
    read_occluders : callable, or None
        Maps a frame to the depth of what may hide the actor, such as other people, shape
        (height, width), meters; 0 elsewhere. None if nothing does.
    """

    camera: Camera
    n_frames: int
    frame_rate: float
    read_depth: Callable[[int], DepthImage]
    read_color: Callable[[int], ColorImage] | None = None
    read_occluders: Callable[[int], DepthImage | None] | None = None

    def __post_init__(self) -> None:
        if self.n_frames < 1:
            raise InvalidMotionError("A depth recording needs at least one frame.")
        check_frame_rate(self.frame_rate)

    def frame(self, index: int) -> DepthImage:
        """Return the depth of a frame, shape (height, width), meters; 0: no reading."""
        self._check(index)
        depth = np.asarray(self.read_depth(index), dtype=np.float32)
        if depth.shape != (self.camera.height, self.camera.width):
            raise InvalidMotionError(
                f"Frame {index} has {depth.shape[::-1]} pixels, not"
                f" {(self.camera.width, self.camera.height)} as the camera."
            )
        return np.where(np.isfinite(depth) & (depth > 0.0), depth, np.float32(0.0))

    def color(self, index: int) -> ColorImage | None:
        """Return the colors (height, width, 3) of a frame, 0 to 255, or None without color."""
        self._check(index)
        return None if self.read_color is None else self.read_color(index)

    def occluders(self, index: int) -> DepthImage | None:
        """Return the depth of what may hide the actor in a frame, meters, or None."""
        self._check(index)
        return None if self.read_occluders is None else self.read_occluders(index)

    def _check(self, index: int) -> None:
        if not 0 <= index < self.n_frames:
            raise InvalidMotionError(
                f"There is no frame {index}; the recording has frames 0 to {self.n_frames - 1}."
            )
