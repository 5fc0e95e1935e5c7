"""Read raw depth: 16-bit little-endian pixels without a header, as in skeltrack."""

from pathlib import Path

import numpy as np

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...files import unreadable_error
from ...progress import Progress, unwatched
from ..containers import PlainBytes
from ..conventions import DEFAULT_FRAME_RATE, MILLIMETER
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import DepthStack, check_size

KINECT_V1 = Camera(571.26, 571.26, 319.5, 239.5, 640, 480)
"""Camera of a Kinect v1, focal lengths in pixels: by definition twice that of UTD-MHAD (`mat`),
at twice the resolution."""
PIXEL_BYTES = 2
MAX_DEPTH_MM = 10_000
"""Maximum distance of a Kinect's reading, millimeters. By definition of libfreenect
(`FREENECT_DEPTH_MM_MAX_VALUE`)."""
MIN_OBSERVED_FRACTION, MAX_STEP_MM = 0.02, 40
"""Minimum fraction of neighbors that both have a reading, and maximum median step between them,
mm. Both guard `test_other_numbers_of_16_bits_are_no_depth`. Measured: an actor without his
room, as in the images of skeltrack, fills 0.22 to 0.28 with steps of 0 mm; random numbers up to
the maximum have steps of 2,900 mm."""


def is_depth_raw(path: Path, head: bytes) -> bool:
    """Return whether a file is raw depth, by its size and by smooth depth across neighbors."""
    frame = KINECT_V1.width * KINECT_V1.height * PIXEL_BYTES
    size = path.stat().st_size
    if size == 0 or size % frame:
        return False
    image = np.frombuffer(PlainBytes(path, 0, frame).read(0, frame), "<u2").astype(np.int32)
    image = image.reshape(KINECT_V1.height, KINECT_V1.width)
    is_pair = (image[:, 1:] > 0) & (image[:, :-1] > 0)
    if image.max() > MAX_DEPTH_MM or is_pair.mean() < MIN_OBSERVED_FRACTION:
        return False
    steps = np.abs(np.diff(image, axis=1))[is_pair]
    return bool(np.median(steps) <= MAX_STEP_MM and image.std() > MAX_STEP_MM)


def read_depth_raw(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read frames of unsigned 16-bit little-endian pixels in row-major order, without a header.

    By default they are millimeters of a Kinect v1, 640 x 480, 30 Hz.

    Parameters and errors are those of `read_depth`.
    """
    path = Path(path)
    width, height = settings.width or KINECT_V1.width, settings.height or KINECT_V1.height
    default_camera = (
        KINECT_V1 if (width, height) == (KINECT_V1.width, KINECT_V1.height) else None
    )
    camera = settings.camera(width, height, default_camera)
    if camera is None:
        raise InvalidFileError(
            f"{path} has images of {width} x {height} pixels from an unknown camera. Set its"
            " focal lengths fx and fy in pixels."
        )
    check_size(path, camera.height, camera.width)
    try:
        size = path.stat().st_size
    except OSError as error:
        raise unreadable_error(path, error) from None
    n_frames, rest = divmod(size, camera.width * camera.height * PIXEL_BYTES)
    if rest or not n_frames:
        raise InvalidFileError(
            f"{path} has {size} bytes, which is not a multiple of an image of {camera.width} x"
            f" {camera.height} pixels: it is cut short, or comes from a different camera."
        )
    stack = DepthStack(
        PlainBytes(path, 0, size),
        "<u2",
        (camera.height, camera.width),
        settings.scale or MILLIMETER,
    )
    progress(1.0, "Reading")
    return DepthRecording(camera, n_frames, settings.frame_rate or DEFAULT_FRAME_RATE, stack)
