"""Read folders of depth images from different recorders."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...faults import attempt
from ...progress import Progress, Remark, unwatched
from ..containers import PngHeader, is_listed, read_png_header
from ..conventions import DEFAULT_FRAME_RATE
from .camera_orientation import rotate_upright
from .image_frames import Frames, frames_by_number, frames_by_time
from .images import NO_IMAGE, ColorImageFiles, DepthImageFiles
from .layouts import Layout, open3d_layout, plain_layout, tum_layout
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings
from .stack import check_size
from .stray_scanner import stray_layout

LAYOUTS = (stray_layout, tum_layout, open3d_layout, plain_layout)
"""Layouts in the order of detection, the most specific first."""
BITS = 16
MIN_GOOD_FRACTION = 0.5
"""Minimum fraction of the images that must be present and undamaged. Chosen by hand: x2 fails
`test_a_picture_that_is_cut_short_is_an_empty_frame`."""


def detect_layout(path: Path) -> Layout | None:
    """Return the layout of a folder of depth images; None for another folder."""
    if not path.is_dir():
        return None
    layouts = (layout(path) for layout in LAYOUTS)
    return next((layout for layout in layouts if layout is not None), None)


def is_depth_folder(path: Path) -> bool:
    """Return whether a folder is a depth recording, and not a folder of other images.

    A damaged depth recording counts as one; its reader reports the damage. Images without
    metadata are depth if the first undamaged one is gray with 16 bits.
    """
    try:
        layout = detect_layout(path)
    except InvalidFileError:
        return True
    if layout is None:
        return False
    if layout.meters:
        return True
    headers = (attempt(path, read_png_header, layout.root, name) for name in layout.depth)
    header = next((header for header in headers if isinstance(header, PngHeader)), None)
    if header is None:
        return "/" in layout.depth[0]  # a folder called depth
    return header.bits == BITS and header.gray


def read_depth_folder(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a folder of 16-bit PNG files of depth: TUM RGB-D, Stray Scanner, Open3D or plain.

    Parameters and errors are those of `read_depth`. Missing or damaged images become empty
    frames, and so do gaps between time stamps.
    """
    path = Path(path)
    layout = detect_layout(path)
    if layout is None:
        raise InvalidFileError(f"{path} is a folder without depth images.")
    is_good, header = _check_images(layout, progress)
    meters, camera = resolve_camera(path, layout, settings, header)
    frames = _frames(path, layout, settings)
    images = np.where(frames.images != NO_IMAGE, frames.images, 0)
    image_indices = np.where(
        (frames.images != NO_IMAGE) & is_good[images], frames.images, NO_IMAGE
    )
    shape = (header.height, header.width)
    read_depth = DepthImageFiles(
        layout.root,
        layout.depth,
        image_indices,
        shape,
        meters,
        layout.confidence,
        settings.min_confidence,
    )
    recording = DepthRecording(
        camera,
        len(image_indices),
        frames.frame_rate,
        read_depth,
        _color(layout, image_indices, shape),
    )
    for remark in (
        *layout.remarks,
        *_remarks(layout, is_good, image_indices, frames, settings),
    ):
        progress(1.0, Remark(remark))
    progress(1.0, "Reading")
    held = layout.held if settings.held is CameraOrientation.KNOWN else settings.held
    return rotate_upright(recording, held, mirrored=False)


def _check_images(layout: Layout, progress: Progress) -> tuple[NDArray[np.bool_], PngHeader]:
    """Return which images are present and undamaged, and the header that they share."""
    headers = []
    for index, name in enumerate(layout.depth):
        headers.append(read_png_header(layout.root, name))
        progress(index / len(layout.depth), "Reading")
    headers_found = [header for header in headers if header is not None]
    if not headers_found or len(headers_found) < MIN_GOOD_FRACTION * len(headers):
        raise InvalidFileError(
            f"{layout.root}: {len(headers) - len(headers_found)} of {len(headers)} depth images"
            " are missing or damaged. Copy them again."
        )
    most_common = max(set(headers_found), key=headers_found.count)
    for name, header in zip(layout.depth, headers, strict=True):
        check_depth_header(layout.root / name, header, most_common)
    return np.array([header is not None for header in headers]), most_common


def check_depth_header(path: Path, header: PngHeader | None, most_common: PngHeader) -> None:
    """Raise InvalidFileError unless a header is that of depth, and equal to the most common."""
    if header is None:
        return
    if header.bits != BITS or not header.gray:
        kind = "gray" if header.gray else "colored"
        raise InvalidFileError(
            f"{path} is a {kind} image of {header.bits} bits; depth is gray and has {BITS}."
            " Export the distances themselves, not a rendered image of them."
        )
    if header != most_common:
        raise InvalidFileError(
            f"{path} has {header.width} x {header.height} pixels, the others"
            f" {most_common.width} x {most_common.height}. Remove it from the folder."
        )
    check_size(path, header.height, header.width)


def resolve_camera(
    path: Path, layout: Layout, settings: DepthSettings, header: PngHeader
) -> tuple[float, Camera]:
    """Return meters per unit and the camera; raise InvalidFileError if one is unknown."""
    meters = settings.scale or layout.meters
    camera = settings.camera(header.width, header.height, _camera(layout, header))
    if meters and camera:
        return meters, camera
    unit = " its scale (meters per unit: 0.001 for millimeters)"
    focal = (
        " the camera's focal lengths fx and fy in pixels, and its center cx and cy unless it is"
        " the middle"
    )
    missing = " and".join([*([] if meters else [unit]), *([] if camera else [focal])])
    raise InvalidFileError(f"{path} does not describe its images completely: set{missing}.")


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
    layout: Layout, image_indices: NDArray[np.intp], shape: tuple[int, int]
) -> ColorImageFiles | None:
    if layout.color is None or layout.color_of is None:
        return None
    color_indices = np.where(
        image_indices == NO_IMAGE, NO_IMAGE, layout.color_of[image_indices]
    )
    used = np.unique(color_indices[color_indices != NO_IMAGE])
    if not any(_may_be_read(layout.root, layout.color[number]) for number in used):
        return None
    return ColorImageFiles(layout.root, layout.color, color_indices, shape)


def _may_be_read(root: Path, name: str) -> bool:
    """Return whether a color image exists, or is a fault to report when color is used."""
    try:
        return is_listed(root, name)
    except InvalidFileError:
        return True


def _remarks(
    layout: Layout,
    is_good: NDArray[np.bool_],
    image_indices: NDArray[np.intp],
    frames: Frames,
    settings: DepthSettings,
) -> list[str]:
    remarks = []
    if layout.times is not None and not settings.frame_rate:
        remarks.append(f"Resampled to {frames.frame_rate:.4g} Hz from its time stamps")
    if not is_good.all():
        first = layout.depth[int(np.argmin(is_good))]
        remarks.append(
            f"{(~is_good).sum()} of {len(is_good)} images are missing or damaged, {first}"
            " first; their frames are empty."
        )
    empty = int((frames.images == NO_IMAGE).sum())
    if empty:
        gap = int(np.argmax(frames.images == NO_IMAGE))
        remarks.append(f"{empty} frames have no image, frame {gap + 1} first; they are empty.")
    return remarks
