"""Follow an `.mkv` that the recorder of an Azure Kinect or a Femto writes."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...depth_scene import Camera, DepthImage, DepthRecording
from ...errors import InvalidFileError
from ...files import unreadable_error
from ...progress import unwatched
from ..containers import Matroska, index_matroska
from ..conventions import DEFAULT_FRAME_RATE
from ..depth_files import (
    DEFAULT_DEPTH_SETTINGS,
    NANOSECOND,
    PIXEL_BYTES,
    DepthBlocks,
    DepthSettings,
    depth_track,
    is_video,
    read_depth_mkv,
    rotate_upright,
)
from .growing_source import ImagePositions, NewImage, measure_positions
from .image_names import PositionKind
from .left_out_images import LeftOutImages, Why


class GrowingMkv:
    """A Matroska file with raw depth, while it grows; it need not exist yet.

    An image is read once its element is complete.

    Parameters
    ----------
    path : Path
    settings : DepthSettings
    """

    def __init__(self, path: Path, settings: DepthSettings = DEFAULT_DEPTH_SETTINGS) -> None:
        self._path, self._settings = path, settings
        self._index = Matroska()
        self._blocks: DepthBlocks | None = None
        self._file_camera: Camera | None = None
        self._size, self._n_read = 0, 0
        self._left_out = LeftOutImages()
        self._was_cut_off = False
        self.is_gone = False
        self.issue = f"No file {path} came. Check the file that the recorder writes to."
        self.camera: Camera | None = None

    def poll(self) -> list[NewImage]:
        """Return the images that were finished since the last call, in their order."""
        try:
            state = self._path.stat()
        except FileNotFoundError:
            self.is_gone = self.is_gone or self._size > 0
            return []
        except OSError as error:
            raise unreadable_error(self._path, error) from None
        if not self._size:
            self.issue = (
                f"{self._path} contains no image yet. Check that the recorder writes depth to"
                " it."
            )
        if state.st_size < self._size:
            self.is_gone = self._was_cut_off = True
        if self.is_gone or state.st_size == self._size:
            return []
        self._size = state.st_size
        return self._finished(state.st_mtime)

    def _finished(self, written: float) -> list[NewImage]:
        try:
            index_matroska(self._path, is_video, unwatched, self._index)
            track, (width, height) = depth_track(self._path, self._index)
        except InvalidFileError as error:  # Its head is still being written, perhaps.
            self.issue = str(error)
            return []
        if self._blocks is None:
            self._open()
        times = np.frombuffer(track.times[self._n_read :], np.int64) * NANOSECOND
        finished = []
        for time in times.tolist():
            name = str(self._n_read)
            if track.sizes[self._n_read] == width * height * PIXEL_BYTES:
                finished.append(NewImage(name, time, written))
            else:
                self._left_out.add(Why.DAMAGED, name)
            self._n_read += 1
        return finished

    def _open(self) -> None:
        recording = read_depth_mkv(self._path, self._settings)
        assert isinstance(recording.read_depth, DepthBlocks)
        self._blocks, self._file_camera = recording.read_depth, recording.camera
        upright = rotate_upright(recording, self._settings.held, self._settings.mirrored)
        self.camera = upright.camera

    def read(self, image: NewImage) -> DepthImage | None:
        """Return the depth of an image, meters; None if it was removed."""
        assert self._blocks is not None and self._file_camera is not None
        track, _ = depth_track(self._path, self._index)
        offset = np.array([track.offsets[int(image.name)]])
        recording = DepthRecording(
            self._file_camera, 1, DEFAULT_FRAME_RATE, replace(self._blocks, offsets=offset)
        )
        upright = rotate_upright(recording, self._settings.held, self._settings.mirrored)
        try:
            return upright.frame(0)
        except InvalidFileError:
            self._left_out.add(Why.DAMAGED, image.name)
            return None

    def positions(self, positions: Sequence[float]) -> ImagePositions:
        """Return the rate of the recording from the positions of its first images."""
        rate = self._settings.frame_rate or DEFAULT_FRAME_RATE
        kind = PositionKind.ORDER if self._settings.frame_rate else PositionKind.TIMES
        return measure_positions(kind, positions, rate)

    def remarks(self) -> tuple[str, ...]:
        """Return a sentence on each kind of image that was left out."""
        gone = (
            f"{self._path} became shorter while it was followed. The motion ends there."
            if self._was_cut_off
            else f"{self._path} was removed while it was followed. The motion ends there."
        )
        return (*self._left_out.sentences(), *((gone,) if self.is_gone else ()))
