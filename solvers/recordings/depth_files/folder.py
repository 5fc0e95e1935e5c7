"""Read folders of depth pictures, whoever recorded them."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...faults import attempt
from ...progress import Progress, unwatched
from ..containers import PngHeader, is_listed, read_png_header
from ..conventions import DEFAULT_FRAME_RATE
from .camera_orientation import rotate_upright
from .image_frames import Frames, frames_by_number, frames_by_time
from .images import NONE, ColorImageFiles, DepthImageFiles
from .layouts import Layout, open3d_layout, plain_layout, tum_layout
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings
from .stack import check_size
from .stray_scanner import stray_layout

LAYOUTS = (stray_layout, tum_layout, open3d_layout, plain_layout)
"""The more a layout asks for, the earlier it is tried."""
BITS = 16
MIN_GOOD_FRACTION = 0.5
"""Share of the pictures that must be there and whole."""


def layout_of(path: Path) -> Layout | None:
    """Return how a folder of depth pictures is laid out; None for one that is none."""
    if not path.is_dir():
        return None
    found = (layout(path) for layout in LAYOUTS)
    return next((layout for layout in found if layout is not None), None)


def is_depth_folder(path: Path) -> bool:
    """Tell whether a folder is one recording of depth, and holds no pictures of another kind.

    Of one that says that it is, but is damaged, whoever reads it will tell; pictures without
    anything that says so are depth if the first whole one is.
    """
    try:
        layout = layout_of(path)
    except InvalidFileError:
        return True
    if layout is None:
        return False
    if layout.metres:
        return True
    headers = (attempt(path, read_png_header, layout.root, name) for name in layout.depth)
    header = next((header for header in headers if isinstance(header, PngHeader)), None)
    if header is None:
        return "/" in layout.depth[0]  # A folder called depth.
    return header.bits == BITS and header.grey


def read_depth_folder(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a folder of 16-bit PNG files of depth: TUM RGB-D, Stray Scanner, Open3D or plain.

    Parameters and errors are those of `read_depth`. Pictures that are missing or damaged are
    frames without a reading, as are holes between time stamps.
    """
    path = Path(path)
    layout = layout_of(path)
    if layout is None:
        raise InvalidFileError(f"{path} is a folder without pictures of depth.")
    good, header = _check_images(layout, progress)
    metres, camera = _resolve_camera(path, layout, settings, header)
    frames = _frames(path, layout, settings)
    pictures = np.where(frames.pictures != NONE, frames.pictures, 0)
    shown = np.where((frames.pictures != NONE) & good[pictures], frames.pictures, NONE)
    shape = (header.height, header.width)
    read_depth = DepthImageFiles(
        layout.root,
        layout.depth,
        shown,
        shape,
        metres,
        layout.confidence,
        settings.least_confidence,
    )
    recording = DepthRecording(
        camera, len(shown), frames.frame_rate, read_depth, _color(layout, shown, shape)
    )
    for remark in (*layout.remarks, *_remarks(layout, good, shown, frames, settings)):
        progress(1.0, remark)
    progress(1.0, "Reading")
    held = layout.held if settings.held is CameraOrientation.KNOWN else settings.held
    return rotate_upright(recording, held, mirrored=False)


def _check_images(layout: Layout, progress: Progress) -> tuple[NDArray[np.bool_], PngHeader]:
    """Tell which pictures are there and whole, and of which size all of them are."""
    headers = []
    for place, name in enumerate(layout.depth):
        headers.append(read_png_header(layout.root, name))
        progress(place / len(layout.depth), "Reading")
    known = [header for header in headers if header is not None]
    if not known or len(known) < MIN_GOOD_FRACTION * len(headers):
        raise InvalidFileError(
            f"{layout.root}: {len(headers) - len(known)} of {len(headers)} pictures of depth"
            " are missing or damaged. Copy them again."
        )
    usual = max(set(known), key=known.count)
    for name, header in zip(layout.depth, headers, strict=True):
        _check(layout.root / name, header, usual)
    return np.array([header is not None for header in headers]), usual


def _check(path: Path, header: PngHeader | None, usual: PngHeader) -> None:
    if header is None:
        return
    if header.bits != BITS or not header.grey:
        kind = "grey" if header.grey else "coloured"
        raise InvalidFileError(
            f"{path} is a {kind} picture of {header.bits} bits; depth is grey and of {BITS}."
            " Export the distances themselves, not a picture of them."
        )
    if header != usual:
        raise InvalidFileError(
            f"{path} has {header.width} x {header.height} pixels, the others"
            f" {usual.width} x {usual.height}. Take it out of the folder."
        )
    check_size(path, header.height, header.width)


def _resolve_camera(
    path: Path, layout: Layout, settings: DepthSettings, header: PngHeader
) -> tuple[float, Camera]:
    """Return metres in a unit and the camera, or say what has to be given."""
    metres = settings.scale or layout.metres
    camera = settings.camera(header.width, header.height, _camera(layout, header))
    if metres and camera:
        return metres, camera
    unit = " its scale (metres in one unit: 0.001 for millimetres)"
    focal = (
        " the camera's focal lengths fx and fy in pixels, and its centre cx and cy unless it is"
        " the middle"
    )
    wanted = " and".join([*([] if metres else [unit]), *([] if camera else [focal])])
    raise InvalidFileError(f"{path} does not tell everything about its pictures: give{wanted}.")


def _camera(layout: Layout, header: PngHeader) -> Camera | None:
    if layout.focal is None:
        return None
    fx, fy, cx, cy = layout.focal
    width, height = layout.focal_size or (header.width, header.height)
    across, down = header.width / width, header.height / height
    return Camera(
        fx * across,
        fy * down,
        (cx + 0.5) * across - 0.5,
        (cy + 0.5) * down - 0.5,
        header.width,
        header.height,
    )


def _frames(path: Path, layout: Layout, settings: DepthSettings) -> Frames:
    if layout.times is not None and not settings.frame_rate:
        return frames_by_time(path, layout.times)
    rate = settings.frame_rate or layout.rate or DEFAULT_FRAME_RATE
    return frames_by_number(layout.depth, rate)


def _color(
    layout: Layout, shown: NDArray[np.intp], shape: tuple[int, int]
) -> ColorImageFiles | None:
    if layout.color is None or layout.color_of is None:
        return None
    of = np.where(shown == NONE, NONE, layout.color_of[shown])
    used = np.unique(of[of != NONE])
    if not any(_may_be_read(layout.root, layout.color[number]) for number in used):
        return None
    return ColorImageFiles(layout.root, layout.color, of, shape)


def _may_be_read(root: Path, name: str) -> bool:
    """Whether a color image is there, or is a fault to report when color is used."""
    try:
        return is_listed(root, name)
    except InvalidFileError:
        return True


def _remarks(
    layout: Layout,
    good: NDArray[np.bool_],
    shown: NDArray[np.intp],
    frames: Frames,
    settings: DepthSettings,
) -> list[str]:
    remarks = []
    if layout.times is not None and not settings.frame_rate:
        remarks.append(f"Resampled to {frames.frame_rate:.4g} Hz")
    if not good.all():
        first = layout.depth[int(np.argmin(good))]
        remarks.append(
            f"{(~good).sum()} of {len(good)} pictures are missing or damaged, {first} first;"
            " their frames are empty."
        )
    empty = int((frames.pictures == NONE).sum())
    if empty:
        gap = int(np.argmax(frames.pictures == NONE))
        remarks.append(f"{empty} frames have no picture, frame {gap} first; they are empty.")
    return remarks
