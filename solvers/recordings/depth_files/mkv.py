"""Read recordings of the Azure Kinect and the Femto: Matroska with raw depth in it."""

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthImage, DepthRecording
from ...errors import InvalidFileError
from ...progress import Progress, unwatched, within
from ..containers import Matroska, PlainBytes, Track, index_matroska, is_matroska
from ..conventions import DEFAULT_FRAME_RATE
from .image_frames import Frames, frames_by_time, match_times
from .images import NONE
from .k4a_calibration import K4aCamera, depth_camera
from .k4a_color import ColorBlocks, color_blocks
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import MILLIMETER, check_size

VIDEO = "V_MS/VFW/FOURCC"
RAW = b"b16g"
BITMAP_HEADER = "<IiiHH4s"
DEPTH, COLOR = "DEPTH", "COLOR"
CALIBRATION = "calibration.json"
PIXEL_BYTES = 2
NANOSECOND = 1e-9


def is_depth_mkv(path: Path, head: bytes) -> bool:
    """Tell from the first bytes; other videos are found out when they are read."""
    return is_matroska(head)


@dataclass(frozen=True, eq=False)
class DepthBlocks:
    """Reads raw pictures in a Matroska file; to be `DepthRecording.read_depth`.

    Attributes
    ----------
    path : Path
    places : int array, shape (n_frames,), bytes
        Where each picture stands; -1: there is none, and the frame is empty.
    shape : (int, int)
    metres : float
        Metres in one unit of a pixel.
    straight : int array, shape (height * width,), or None
        Of which pixel of the distorted picture each pixel sees the depth; -1: none.
    """

    path: Path
    places: NDArray[np.int64]
    shape: tuple[int, int]
    metres: float
    straight: NDArray[np.int32] | None

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of a frame, metres; 0: no reading."""
        place = int(self.places[index])
        if place == NONE:
            return np.zeros(self.shape, np.float32)
        size = self.shape[0] * self.shape[1] * PIXEL_BYTES
        pixels = np.frombuffer(PlainBytes(self.path, place, size).read(0, size), ">u2")
        if self.straight is not None:
            pixels = np.where(self.straight == NONE, 0, pixels[self.straight])
        return (pixels.reshape(self.shape) * self.metres).astype(np.float32)


def read_depth_mkv(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read an `.mkv` of k4arecorder or of Orbbec's: 16-bit depth and the cameras' calibration.

    The lens bends the picture; each pixel takes the depth of the one that saw in its direction,
    so that a camera without distortion remains. Colour is brought to the pixels of depth where
    it was recorded as MJPG or BGRA.

    Parameters and errors are those of `read_depth`. A file that was cut short is read up to
    there. Pictures that were lost are frames without a reading.
    """
    path = Path(path)
    found = index_matroska(path, _is_video, within(progress, 0.0, 0.9))
    track, (width, height) = _depth_track(path, found)
    check_size(path, height, width)
    lens = _lens(path, found, settings, width, height)
    camera = lens.camera if lens else settings.camera(width, height)
    if camera is None:
        raise InvalidFileError(
            f"{path} has no calibration of the camera in it. Give the camera's focal lengths fx"
            " and fy in pixels."
        )
    frames = _frames(path, track, settings)
    good = np.frombuffer(track.sizes, np.int64) == width * height * PIXEL_BYTES
    if not good.any():
        raise InvalidFileError(
            f"{path} has no picture of {width} x {height} pixels, as its depth should have: it"
            " is damaged. Copy or record it again."
        )
    shown = np.where((frames.pictures != NONE) & good[frames.pictures], frames.pictures, NONE)
    places = np.where(shown == NONE, NONE, np.frombuffer(track.places, np.int64)[shown])
    metres = settings.scale or MILLIMETER
    straight = None if lens is None else _undistort_pixels(lens)
    read_depth = DepthBlocks(path, places, (height, width), metres, straight)
    recording = DepthRecording(
        camera,
        len(shown),
        frames.frame_rate,
        read_depth,
        _color(path, found, lens, track, shown, read_depth),
    )
    for remark in _remarks(found, good, shown):
        progress(1.0, remark)
    progress(1.0, "Reading")
    return recording


def _is_video(track: Track) -> bool:
    return track.codec == VIDEO


def _depth_track(path: Path, found: Matroska) -> tuple[Track, tuple[int, int]]:
    uid = found.tags.get("K4A_DEPTH_TRACK", "")
    raw = [track for track in found.tracks.values() if _fourcc(track) == RAW]
    named = [track for track in raw if track.name == DEPTH or str(track.uid) == uid]
    if not named or not named[0].places:
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
    path: Path, found: Matroska, settings: DepthSettings, width: int, height: int
) -> K4aCamera | None:
    if settings.fx:
        return None
    name = found.tags.get("K4A_CALIBRATION_FILE", CALIBRATION)
    content = found.files.get(name) or found.files.get(CALIBRATION)
    return None if content is None else depth_camera(path, content, width, height)


def _undistort_pixels(lens: K4aCamera) -> NDArray[np.int32]:
    camera = lens.camera
    seen = lens.project(camera.rays()).reshape(-1, 2)
    column, row = np.nan_to_num(seen, nan=-1.0).round().astype(np.int64).T
    inside = (column >= 0) & (column < camera.width) & (row >= 0) & (row < camera.height)
    return np.where(inside, row * camera.width + column, NONE).astype(np.int32)


def _frames(path: Path, track: Track, settings: DepthSettings) -> Frames:
    n_pictures = len(track.times)
    if settings.frame_rate or n_pictures < 2:
        return Frames(np.arange(n_pictures), settings.frame_rate or DEFAULT_FRAME_RATE)
    return frames_by_time(path, np.frombuffer(track.times, np.int64) * NANOSECOND)


def _color(
    path: Path,
    found: Matroska,
    lens: K4aCamera | None,
    depth: Track,
    shown: NDArray[np.intp],
    read_depth: DepthBlocks,
) -> ColorBlocks | None:
    uid = found.tags.get("K4A_COLOR_TRACK", "")
    tracks = [
        track
        for track in found.tracks.values()
        if track.places and (track.name == COLOR or str(track.uid) == uid) and track != depth
    ]
    name = found.tags.get("K4A_CALIBRATION_FILE", CALIBRATION)
    content = found.files.get(name) or found.files.get(CALIBRATION)
    if lens is None or not tracks or content is None:
        return None
    times = [np.frombuffer(each.times, np.int64) * NANOSECOND for each in (depth, tracks[0])]
    of = match_times(*times)
    of = np.where(shown == NONE, NONE, of[shown])
    return color_blocks(path, content, tracks[0], _fourcc(tracks[0]), of, lens, read_depth)


def _remarks(found: Matroska, good: NDArray[np.bool_], shown: NDArray[np.intp]) -> list[str]:
    remarks = []
    if not found.whole:
        remarks.append("The file is cut short; what comes before is read.")
    if not good.all():
        remarks.append(f"{(~good).sum()} pictures are damaged; their frames are empty.")
    n_empty = int((shown == NONE).sum())
    if n_empty and good.all():
        first = int(np.argmax(shown == NONE))
        remarks.append(
            f"{n_empty} frames have no picture, frame {first} first; they are empty."
        )
    return remarks
