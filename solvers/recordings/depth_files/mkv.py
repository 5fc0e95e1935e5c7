"""Read recordings of the Azure Kinect and the Femto: Matroska files with raw depth."""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthImage, DepthRecording
from ...errors import InvalidFileError
from ...progress import Progress, Remark, unwatched, within
from ..containers import Matroska, PlainBytes, Track, index_matroska, is_matroska
from ..conventions import DEFAULT_FRAME_RATE, MILLIMETER
from .image_frames import Frames, frames_by_time, match_times
from .images import NO_IMAGE
from .k4a_calibration import K4aCamera, depth_camera
from .k4a_color import ColorBlocks, color_blocks
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import check_size

VIDEO = "V_MS/VFW/FOURCC"
RAW = b"b16g"
BITMAP_HEADER = "<IiiHH4s"
DEPTH, COLOR = "DEPTH", "COLOR"
CALIBRATION = "calibration.json"
PIXEL_BYTES = 2
NANOSECOND = 1e-9


def is_depth_mkv(path: Path, head: bytes) -> bool:
    """Return whether a file is Matroska, from its first bytes; other videos fail on reading."""
    return is_matroska(head)


@dataclass(frozen=True, eq=False)
class DepthBlocks:
    """Read raw images in a Matroska file; serves as `DepthRecording.read_depth`.

    Attributes
    ----------
    path : Path
    offsets : int array, shape (n_frames,), bytes
        Position of each image in the file; -1: none, and the frame is empty.
    shape : (int, int)
    meters : float
        Meters per unit of a pixel.
    source_pixels : int array, shape (height * width,), or None
        Pixel of the distorted image in the direction of each pixel; -1: none.
    """

    path: Path
    offsets: NDArray[np.int64]
    shape: tuple[int, int]
    meters: float
    source_pixels: NDArray[np.int32] | None

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, meters; 0: no reading."""
        offset = int(self.offsets[index])
        if offset == NO_IMAGE:
            return np.zeros(self.shape, np.float32)
        size = self.shape[0] * self.shape[1] * PIXEL_BYTES
        pixels = np.frombuffer(PlainBytes(self.path, offset, size).read(0, size), ">u2")
        if self.source_pixels is not None:
            pixels = np.where(self.source_pixels == NO_IMAGE, 0, pixels[self.source_pixels])
        return (pixels.reshape(self.shape) * self.meters).astype(np.float32)


def read_depth_mkv(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read an `.mkv` of k4arecorder or Orbbec: 16-bit depth and the calibration of the cameras.

    Lens distortion is removed: each pixel gets the depth of the distorted pixel in its
    direction. Color that was recorded as MJPG or BGRA is aligned with the depth pixels.

    Parameters and errors are those of `read_depth`. A truncated file is read up to its end.
    Dropped images become empty frames.
    """
    path = Path(path)
    index = index_matroska(path, is_video, within(progress, 0.0, 0.9))
    track, (width, height) = depth_track(path, index)
    check_size(path, height, width)
    lens = _lens(path, index, settings, width, height)
    camera = lens.camera if lens else settings.camera(width, height)
    if camera is None:
        raise InvalidFileError(
            f"{path} has no calibration of the camera. Set the camera's focal lengths fx and"
            " fy in pixels."
        )
    frames = _frames(path, track, settings)
    is_good = np.frombuffer(track.sizes, np.int64) == width * height * PIXEL_BYTES
    if not is_good.any():
        raise InvalidFileError(
            f"{path} has no image of {width} x {height} pixels, the size of its depth: it is"
            " damaged. Copy or record it again."
        )
    image_indices = np.where(
        (frames.images != NO_IMAGE) & is_good[frames.images], frames.images, NO_IMAGE
    )
    offsets = np.where(
        image_indices == NO_IMAGE,
        NO_IMAGE,
        np.frombuffer(track.offsets, np.int64)[image_indices],
    )
    meters = settings.scale or MILLIMETER
    source_pixels = None if lens is None else _undistort_pixels(lens)
    read_depth = DepthBlocks(path, offsets, (height, width), meters, source_pixels)
    recording = DepthRecording(
        camera,
        len(image_indices),
        frames.frame_rate,
        read_depth,
        _color(path, index, lens, track, image_indices, read_depth),
    )
    for remark in _remarks(index, is_good, image_indices):
        progress(1.0, Remark(remark))
    progress(1.0, "Reading")
    return recording


def is_video(track: Track) -> bool:
    """Return whether a track may hold raw depth."""
    return track.codec == VIDEO


def depth_track(path: Path, index: Matroska) -> tuple[Track, tuple[int, int]]:
    """Return the track of depth, and the width and height of its images."""
    uid = index.tags.get("K4A_DEPTH_TRACK", "")
    raw = [track for track in index.tracks.values() if _fourcc(track) == RAW]
    named = [track for track in raw if track.name == DEPTH or str(track.uid) == uid]
    if not named or not named[0].offsets:
        raise InvalidFileError(
            f"{path} is a video without raw depth (a track called DEPTH with frames). Record it"
            " with k4arecorder, in another depth mode than PASSIVE_IR."
        )
    _, width, height, *_ = struct.unpack_from(BITMAP_HEADER, named[0].private)
    return named[0], (width, abs(height))


def _fourcc(track: Track) -> bytes:
    if len(track.private) < struct.calcsize(BITMAP_HEADER):
        return b""
    kind: bytes = struct.unpack_from(BITMAP_HEADER, track.private)[-1]
    return kind


def _lens(
    path: Path, index: Matroska, settings: DepthSettings, width: int, height: int
) -> K4aCamera | None:
    if settings.fx:
        return None
    name = index.tags.get("K4A_CALIBRATION_FILE", CALIBRATION)
    content = index.files.get(name) or index.files.get(CALIBRATION)
    return None if content is None else depth_camera(path, content, width, height)


def _undistort_pixels(lens: K4aCamera) -> NDArray[np.int32]:
    camera = lens.camera
    columns_and_rows = lens.project(camera.rays()).reshape(-1, 2)
    column, row = np.nan_to_num(columns_and_rows, nan=-1.0).round().astype(np.int64).T
    inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
    return np.where(inside, row * camera.width + column, NO_IMAGE).astype(np.int32)


def _frames(path: Path, track: Track, settings: DepthSettings) -> Frames:
    n_images = len(track.times)
    if settings.frame_rate or n_images < 2:
        return Frames(np.arange(n_images), settings.frame_rate or DEFAULT_FRAME_RATE)
    return frames_by_time(path, np.frombuffer(track.times, np.int64) * NANOSECOND)


def _color(
    path: Path,
    index: Matroska,
    lens: K4aCamera | None,
    depth: Track,
    image_indices: NDArray[np.intp],
    read_depth: DepthBlocks,
) -> ColorBlocks | None:
    uid = index.tags.get("K4A_COLOR_TRACK", "")
    tracks = [
        track
        for track in index.tracks.values()
        if track.offsets and (track.name == COLOR or str(track.uid) == uid) and track != depth
    ]
    name = index.tags.get("K4A_CALIBRATION_FILE", CALIBRATION)
    content = index.files.get(name) or index.files.get(CALIBRATION)
    if lens is None or not tracks or content is None:
        return None
    times = [np.frombuffer(each.times, np.int64) * NANOSECOND for each in (depth, tracks[0])]
    color_indices = match_times(*times)
    color_indices = np.where(image_indices == NO_IMAGE, NO_IMAGE, color_indices[image_indices])
    return color_blocks(
        path, content, tracks[0], _fourcc(tracks[0]), color_indices, lens, read_depth
    )


def _remarks(
    index: Matroska, is_good: NDArray[np.bool_], image_indices: NDArray[np.intp]
) -> list[str]:
    remarks = []
    if not index.is_complete:
        remarks.append("The file is cut short; the frames before the end are read.")
    if not is_good.all():
        remarks.append(f"{(~is_good).sum()} images are damaged; their frames are empty.")
    n_empty = int((image_indices == NO_IMAGE).sum())
    if n_empty and is_good.all():
        first = int(np.argmax(image_indices == NO_IMAGE)) + 1
        remarks.append(f"{n_empty} frames have no image, frame {first} first; they are empty.")
    return remarks
