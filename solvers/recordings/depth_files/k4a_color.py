"""Align the color images of an Azure Kinect with its depth pixels."""

import io
import struct
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import ColorImage, DepthImage
from ...errors import InvalidFileError
from ...files import DAMAGE
from ..containers import PlainBytes, Track, max_color_size, open_bounded_image
from .images import NO_IMAGE
from .k4a_calibration import K4aCamera, color_camera

JPEG, BGRA = b"MJPG", b"BGRA"


class _ReadDepth(Protocol):
    def __call__(self, index: int) -> DepthImage: ...


@dataclass(frozen=True, eq=False)
class ColorBlocks:
    """Read color aligned with the depth pixels; serves as `DepthRecording.read_color`.

    Attributes
    ----------
    path : Path
    offsets, sizes : int arrays, shape (n_frames,), bytes
        Position of each color image in the file; -1: none, and the frame is black.
    kind : bytes
        MJPG or BGRA.
    depth_lens, color_lens : K4aCamera
    read_depth : callable
        Returns the depth of a frame.
    """

    path: Path
    offsets: NDArray[np.int64]
    sizes: NDArray[np.int64]
    kind: bytes
    depth_lens: K4aCamera
    color_lens: K4aCamera
    read_depth: _ReadDepth

    def __call__(self, index: int) -> ColorImage:
        """Return the colors (height, width, 3) of a frame; black where depth is missing."""
        depth = self.read_depth(index)
        colors = np.zeros((*depth.shape, 3), np.uint8)
        offset, size = int(self.offsets[index]), int(self.sizes[index])
        if offset == NO_IMAGE:
            return colors
        image_pixels = self._decode(PlainBytes(self.path, offset, size).read(0, size))
        points = (
            self.depth_lens.camera.back_project(depth) @ self.color_lens.rotation.T
            + self.color_lens.translation
        )
        points[depth == 0.0] = np.nan
        column, row = np.moveaxis(self.color_lens.project(points), -1, 0)
        column, row = (np.nan_to_num(each, nan=-1.0).round() for each in (column, row))
        inside = (column >= 0) & (column < image_pixels.shape[1])
        inside &= (row >= 0) & (row < image_pixels.shape[0])
        colors[inside] = image_pixels[row[inside].astype(int), column[inside].astype(int)]
        return colors

    def _decode(self, content: bytes) -> ColorImage:
        camera = self.color_lens.camera
        if self.kind == BGRA:
            pixels = np.frombuffer(content, np.uint8)
            if pixels.size != 4 * camera.width * camera.height:
                raise InvalidFileError(f"{self.path} has a damaged color image.")
            return pixels.reshape(camera.height, camera.width, 4)[..., 2::-1]
        try:
            max_size = camera.width, camera.height
            with open_bounded_image(
                self.path, io.BytesIO(content), max_size, ("JPEG",)
            ) as image:
                return np.asarray(image.convert("RGB"), np.uint8)
        except DAMAGE:
            raise InvalidFileError(f"{self.path} has a damaged color image.") from None


def color_blocks(
    path: Path,
    calibration: bytes,
    track: Track,
    kind: bytes,
    color_indices: NDArray[np.intp],
    depth_lens: K4aCamera,
    read_depth: _ReadDepth,
) -> ColorBlocks | None:
    """Return the reader of a color track; None for unsupported formats (NV12, YUY2).

    Color with more pixels than `max_color_size` allows for the depth is not supported either.

    `color_indices` is the index of the image of each frame in the track, -1 for none.
    """
    if kind not in {JPEG, BGRA}:
        return None
    width, height = struct.unpack_from("<ii", track.private, 4)
    max_size = max_color_size((depth_lens.camera.height, depth_lens.camera.width))
    if not (0 < width <= max_size[0] and 0 < abs(height) <= max_size[1]):
        return None
    color_lens = color_camera(path, calibration, width, abs(height))
    offsets = np.frombuffer(track.offsets, np.int64)
    sizes = np.frombuffer(track.sizes, np.int64)
    return ColorBlocks(
        path,
        np.where(color_indices == NO_IMAGE, NO_IMAGE, offsets[color_indices]),
        sizes[color_indices],
        kind,
        depth_lens,
        color_lens,
        read_depth,
    )
