"""Read raw depth: pixels of 16 bits, low byte first, and nothing else, as skeltrack has it."""

from pathlib import Path

import numpy as np

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...files import unreadable
from ...progress import Progress, unwatched
from ..containers import PlainBytes
from ..conventions import DEFAULT_FRAME_RATE
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import MILLIMETER, DepthStack, check_size

KINECT_V1 = Camera(571.26, 571.26, 319.5, 239.5, 640, 480)
PIXEL = 2
MAX_DEPTH_MM = 12_000
"""Millimetres, of what a Kinect sees."""
MIN_OBSERVED_FRACTION, MAX_STEP_MM = 0.02, 40
"""Share of pixels that see something, and millimetres between neighbours, usually."""


def is_depth_raw(path: Path, head: bytes) -> bool:
    """Tell by the size, and by neighbours that are about equally far, as on surfaces."""
    frame = KINECT_V1.width * KINECT_V1.height * PIXEL
    size = path.stat().st_size
    if size == 0 or size % frame:
        return False
    picture = np.frombuffer(PlainBytes(path, 0, frame).read(0, frame), "<u2").astype(np.int32)
    picture = picture.reshape(KINECT_V1.height, KINECT_V1.width)
    both = (picture[:, 1:] > 0) & (picture[:, :-1] > 0)
    if picture.max() > MAX_DEPTH_MM or both.mean() < MIN_OBSERVED_FRACTION:
        return False
    steps = np.abs(np.diff(picture, axis=1))[both]
    return bool(np.median(steps) <= MAX_STEP_MM and picture.std() > MAX_STEP_MM)


def read_depth_raw(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read frames of unsigned 16-bit pixels, low byte first, row by row, without any header.

    Millimetres of a Kinect v1, 640 x 480, 30 Hz, unless said otherwise.

    Parameters and errors are those of `read_depth`.
    """
    path = Path(path)
    width, height = settings.width or KINECT_V1.width, settings.height or KINECT_V1.height
    known = KINECT_V1 if (width, height) == (KINECT_V1.width, KINECT_V1.height) else None
    camera = settings.camera(width, height, known)
    if camera is None:
        raise InvalidFileError(
            f"{path}: nobody knows through which camera pictures of {width} x {height} pixels"
            " were taken. Give its focal lengths fx and fy in pixels."
        )
    check_size(path, camera.height, camera.width)
    try:
        size = path.stat().st_size
    except OSError as error:
        raise unreadable(path, error) from None
    n_frames, rest = divmod(size, camera.width * camera.height * PIXEL)
    if rest or not n_frames:
        raise InvalidFileError(
            f"{path} has {size} bytes, which are no whole pictures of {camera.width} x"
            f" {camera.height} pixels: it is cut short, or the camera is another one."
        )
    stack = DepthStack(
        PlainBytes(path, 0, size),
        "<u2",
        (camera.height, camera.width),
        settings.scale or MILLIMETER,
    )
    progress(1.0, "Reading")
    return DepthRecording(camera, n_frames, settings.frame_rate or DEFAULT_FRAME_RATE, stack)
