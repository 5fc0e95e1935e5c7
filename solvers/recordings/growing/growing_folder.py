"""Follow a folder into which a recorder writes depth images."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import monotonic

import numpy as np

from ...depth_scene import Camera, DepthImage, DepthRecording
from ...errors import InvalidFileError
from ...files import unreadable_error
from ..containers import PngHeader, read_png_header
from ..conventions import DEFAULT_FRAME_RATE
from ..depth_files import (
    DEFAULT_DEPTH_SETTINGS,
    CameraOrientation,
    DepthSettings,
    Layout,
    check_depth_header,
    detect_layout,
    read_pixels,
    resolve_camera,
    rotate_upright,
)
from .growing_source import ImagePositions, NewImage, measure_positions
from .image_names import ImageName, PositionKind, parse_image_name
from .left_out_images import LeftOutImages, Why
from .written_rate import WrittenRate

MAX_HOLD_S = 0.1
"""Seconds for which complete images wait for an earlier one that is still being written. It
bounds the delay; recorders with several writers finish images in another order."""
SCAN_INTERVAL_S = 0.25
"""Seconds after which a folder is listed although it looks unchanged. It bounds the delay where
a file system updates the time of a folder late."""
SUFFIX = ".png"


@dataclass(frozen=True, eq=False)
class _Format:
    """What is known of a folder from its first image."""

    layout: Layout
    subfolder: str
    """Folder of the images below the root, with a slash; empty for the root."""
    header: PngHeader
    meters: float
    camera: Camera
    held: CameraOrientation
    mirrored: bool
    name: ImageName

    def upright(self, depth: DepthImage) -> DepthRecording:
        """Return an image as a recording of an upright camera."""
        recording = DepthRecording(self.camera, 1, DEFAULT_FRAME_RATE, lambda _: depth)
        return rotate_upright(recording, self.held, self.mirrored)


class GrowingFolder:
    """A folder of 16-bit PNG files, in any layout of `read_depth`, while it grows.

    An image is read once it is complete, so a half-written one is looked at again. The folder
    need not exist yet. Images of another size, and those whose names begin differently, are of
    another recorder and left out.

    Parameters
    ----------
    path : Path
    settings : DepthSettings
    now : callable
        Returns seconds.
    """

    def __init__(
        self,
        path: Path,
        settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
        *,
        now: Callable[[], float] = monotonic,
    ) -> None:
        self._path, self._settings, self._now = path, settings, now
        self._format: _Format | None = None
        self._left_out = LeftOutImages()
        self._written_rate = WrittenRate()
        self._assumed: ImagePositions | None = None
        """Rate of images whose files do not state it."""
        self._seen: set[str] = set()
        self._half_written: dict[str, float] = {}
        self._last_position = -np.inf
        self._scanned_at, self._folder_time = -np.inf, 0
        self.is_gone = False
        self.issue = (
            f"No depth image came. Check the folder {path} that the recorder writes to, and"
            " that it writes 16-bit PNG files."
        )
        self.camera: Camera | None = None

    def poll(self) -> list[NewImage]:
        """Return the images that were finished since the last call, in their order."""
        if self._format is None:
            self._format = self._find_format()
            if self._format is None:
                return []
            zeros = np.zeros((self._format.header.height, self._format.header.width), "f4")
            self.camera = self._format.upright(zeros).camera
        if self.is_gone or not (self._half_written or self._may_have_grown()):
            return []
        has_begun = self._last_position > -np.inf
        finished = self._finished(self._format, self._list_new(self._format))
        if has_begun:
            for image in finished:
                self._written_rate.add(image)
        return finished

    def read(self, image: NewImage) -> DepthImage | None:
        """Return the depth of an image, meters; None if it is damaged or was removed."""
        found = self._format
        assert found is not None
        shape = found.header.height, found.header.width
        try:
            pixels = read_pixels(found.layout.root, found.subfolder + image.name, shape)
        except InvalidFileError:
            self._left_out.add(Why.DAMAGED, image.name)
            return None
        return found.upright((pixels * found.meters).astype(np.float32)).frame(0)

    def positions(self, positions: Sequence[float]) -> ImagePositions:
        """Return the rate of the recording from the positions of its first images."""
        assert self._format is not None
        rate = self._settings.frame_rate or self._format.layout.rate or DEFAULT_FRAME_RATE
        kind = self._format.name.kind
        if kind is PositionKind.TIMES and self._settings.frame_rate:
            kind = PositionKind.ORDER
        found = measure_positions(kind, positions, rate)
        is_known = kind is PositionKind.TIMES or self._settings.frame_rate
        self._assumed = None if is_known else found
        return found

    def remarks(self) -> tuple[str, ...]:
        """Return a sentence on each kind of image that was left out, and on an unlikely rate.

        Nothing follows.
        """
        for name in self._half_written:
            self._left_out.add(Why.HALF_WRITTEN, name)
        self._half_written.clear()
        gone = f"{self._path} was removed while it was followed. The motion ends there."
        rate = "" if self._assumed is None else self._written_rate.remark(self._assumed)
        return (
            *self._left_out.sentences(),
            *((rate,) if rate else ()),
            *((gone,) if self.is_gone else ()),
        )

    def _find_format(self) -> _Format | None:
        """Return what the first complete image says; None without one."""
        try:
            layout = detect_layout(self._path)
        except InvalidFileError as error:  # Its description is still being written, perhaps.
            self.issue = str(error)
            return None
        except OSError as error:
            raise unreadable_error(self._path, error) from None
        if layout is None:
            return None
        for name in layout.depth:
            header = read_png_header(layout.root, name)
            if header is not None:
                return self._format_of(layout, name, header)
        return None

    def _format_of(self, layout: Layout, name: str, header: PngHeader) -> _Format:
        check_depth_header(layout.root / name, header, header)
        meters, camera = resolve_camera(self._path, layout, self._settings, header)
        held = self._settings.held
        held = layout.held if held is CameraOrientation.KNOWN else held
        folder, slash, file = name.rpartition("/")
        return _Format(
            layout, folder + slash, header, meters, camera, held, self._settings.mirrored,
            parse_image_name(file),
        )  # fmt: skip

    def _may_have_grown(self) -> bool:
        """Whether the folder has changed, or was not listed for a while."""
        assert self._format is not None
        try:
            changed = (self._path / self._format.subfolder).stat().st_mtime_ns
        except OSError:
            self.is_gone = True
            return False
        now = self._now()
        if changed == self._folder_time and now - self._scanned_at < SCAN_INTERVAL_S:
            return False
        self._folder_time, self._scanned_at = changed, now
        return True

    def _list_new(self, found: _Format) -> list[tuple[ImageName, str]]:
        """Return the images of this recorder that were not there before, in their order."""
        try:
            with os.scandir(self._path / found.subfolder) as entries:
                names = [entry.name for entry in entries]
        except OSError:
            self.is_gone = True
            return []
        new = []
        for name in names:
            if name in self._seen or not name.lower().endswith(SUFFIX) or name[0] == ".":
                continue
            parts = parse_image_name(name)
            if (parts.head, parts.kind) != (found.name.head, found.name.kind):
                self._seen.add(name)
                self._left_out.add(Why.OTHER_NAME, name)
            else:
                new.append((parts, name))
        return sorted(new, key=lambda each: (each[0].position, each[1]))

    def _finished(self, found: _Format, new: list[tuple[ImageName, str]]) -> list[NewImage]:
        """Return those that are complete; later ones wait for an incomplete one, for a time."""
        finished = []
        for parts, name in new:
            if parts.position < self._last_position:
                self._seen.add(name)
                was_half_written = self._half_written.pop(name, None) is not None
                self._left_out.add(Why.HALF_WRITTEN if was_half_written else Why.LATE, name)
                continue
            header = read_png_header(found.layout.root, found.subfolder + name)
            if header is None:
                since = self._half_written.setdefault(name, self._now())
                if self._now() - since < MAX_HOLD_S:
                    break
                continue
            self._half_written.pop(name, None)
            self._seen.add(name)
            if header != found.header:
                self._left_out.add(Why.OTHER_SIZE, name)
            else:
                self._last_position = parts.position
                finished.append(NewImage(name, parts.position, self._written(found, name)))
        return finished

    def _written(self, found: _Format, name: str) -> float:
        try:
            return (self._path / found.subfolder / name).stat().st_mtime
        except OSError:  # It was removed at once; reading it fails, too.
            return 0.0
