"""Colours that the depth pixels of an Azure Kinect see."""

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
from ..containers import PlainBytes, Track, bounded_image, largest_color
from .images import NONE
from .k4a_calibration import K4aCamera, color_camera

JPEG, BGRA = b"MJPG", b"BGRA"


class _ReadDepth(Protocol):
    def __call__(self, index: int) -> DepthImage: ...


@dataclass(frozen=True, eq=False)
class ColorBlocks:
    """Reads colours and brings them to the pixels of depth; `DepthRecording.read_color`.

    Attributes
    ----------
    path : Path
    places, sizes : int arrays, shape (n_frames,), bytes
        Where each picture of colour stands; -1: there is none, and the frame is black.
    kind : bytes
        MJPG or BGRA.
    lens, eye : K4aCamera
        Of depth and of colour.
    read_depth : callable
        Takes a frame and returns its depth.
    """

    path: Path
    places: NDArray[np.int64]
    sizes: NDArray[np.int64]
    kind: bytes
    lens: K4aCamera
    eye: K4aCamera
    read_depth: _ReadDepth

    def __call__(self, index: int) -> ColorImage:
        """Return the colours (height, width, 3) of a frame; black where depth is not known."""
        depth = self.read_depth(index)
        colors = np.zeros((*depth.shape, 3), np.uint8)
        place, size = int(self.places[index]), int(self.sizes[index])
        if place == NONE:
            return colors
        picture = self._picture(PlainBytes(self.path, place, size).read(0, size))
        points = self.lens.camera.back_project(depth) @ self.eye.turn.T + self.eye.shift
        points[depth == 0.0] = np.nan
        column, row = np.moveaxis(self.eye.project(points), -1, 0)
        column, row = (np.nan_to_num(each, nan=-1.0).round() for each in (column, row))
        inside = (column >= 0) & (column < picture.shape[1])
        inside &= (row >= 0) & (row < picture.shape[0])
        colors[inside] = picture[row[inside].astype(int), column[inside].astype(int)]
        return colors

    def _picture(self, content: bytes) -> ColorImage:
        camera = self.eye.camera
        if self.kind == BGRA:
            pixels = np.frombuffer(content, np.uint8)
            if pixels.size != 4 * camera.width * camera.height:
                raise InvalidFileError(f"{self.path} has a damaged picture of colour.")
            return pixels.reshape(camera.height, camera.width, 4)[..., 2::-1]
        try:
            largest = camera.width, camera.height
            with bounded_image(self.path, io.BytesIO(content), largest, ("JPEG",)) as image:
                return np.asarray(image.convert("RGB"), np.uint8)
        except DAMAGE:
            raise InvalidFileError(f"{self.path} has a damaged picture of colour.") from None


def color_blocks(
    path: Path,
    calibration: bytes,
    track: Track,
    kind: bytes,
    of: NDArray[np.intp],
    lens: K4aCamera,
    read_depth: _ReadDepth,
) -> ColorBlocks | None:
    """Return the reader of a track of colour, or None for kinds that are not read (NV12, YUY2).

    Nor is color with more pixels than `largest_color` allows beside the depth.

    `of` is which picture of the track each frame has, -1 for none.
    """
    if kind not in {JPEG, BGRA}:
        return None
    width, height = struct.unpack_from("<ii", track.private, 4)
    most = largest_color((lens.camera.height, lens.camera.width))
    if not (0 < width <= most[0] and 0 < abs(height) <= most[1]):
        return None
    eye = color_camera(path, calibration, width, abs(height))
    places = np.frombuffer(track.places, np.int64)
    sizes = np.frombuffer(track.sizes, np.int64)
    return ColorBlocks(
        path, np.where(of == NONE, NONE, places[of]), sizes[of], kind, lens, eye, read_depth
    )
