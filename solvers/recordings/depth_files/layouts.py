"""Detect the layouts of folders of depth images from different recorders."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import DAMAGE
from ...json_text import parse_json
from ..containers import is_png, read_bytes
from ..conventions import MILLIMETER
from .image_frames import match_times, sort_naturally
from .images import NO_IMAGE
from .settings import CameraOrientation

Focal = tuple[float, float, float, float]

TUM_UNIT = 1.0 / 5000.0
IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg")
COLOR_FOLDERS = ("color", "rgb", "image")


@dataclass(frozen=True, eq=False)
class Layout:
    """Description of a folder of images.

    Attributes
    ----------
    root : Path
    depth : tuple of str
        Depth files relative to the root, in their order.
    times : float array, shape (n_files,), seconds, or None
    rate : float, hertz, or None
        If there are no times.
    meters : float, or None
        Meters per unit of a pixel; None if unknown.
    focal : (fx, fy, cx, cy), pixels, or None
    focal_size : (int, int), or None
        Width and height of the images that `focal` refers to; None: those of depth.
    color : tuple of str, or None
    color_of : int array, shape (n_files,), or None
        Index of the color file of each depth file; -1: none.
    confidence : tuple of str, or None
    held : CameraOrientation
    remarks : tuple of str
    """

    root: Path
    depth: tuple[str, ...]
    times: NDArray[np.float64] | None = None
    rate: float | None = None
    meters: float | None = None
    focal: Focal | None = None
    focal_size: tuple[int, int] | None = None
    color: tuple[str, ...] | None = None
    color_of: NDArray[np.intp] | None = None
    confidence: tuple[str, ...] | None = None
    held: CameraOrientation = CameraOrientation.UPRIGHT
    remarks: tuple[str, ...] = field(default=())


def tum_layout(root: Path) -> Layout | None:
    """Return the layout of TUM RGB-D: `depth.txt` and `rgb.txt`, or `associations.txt`."""
    if (root / "depth.txt").is_file():
        times, names = _read_list(root / "depth.txt")
        layout = Layout(root, names, times, meters=TUM_UNIT)
        if not (root / "rgb.txt").is_file():
            return layout
        color_times, color = _read_list(root / "rgb.txt")
        return _with_color(layout, color, match_times(times, color_times))
    for name in ("associations.txt", "associates.txt", "associated.txt"):
        if (root / name).is_file():
            return _associated(root, root / name)
    return None


def _associated(root: Path, path: Path) -> Layout:
    rows = _words(path, 4)
    if not rows:
        raise InvalidFileError(f"{path} lists no images.")
    first_is_depth = "depth" in rows[0][1] and "depth" not in rows[0][3]
    depth, color = (0, 2) if first_is_depth else (2, 0)
    layout = Layout(
        root,
        tuple(row[depth + 1] for row in rows),
        _times(path, [row[depth] for row in rows]),
        meters=TUM_UNIT,
    )
    return _with_color(layout, [row[color + 1] for row in rows], np.arange(len(rows)))


def _with_color(
    layout: Layout, names: Sequence[str], color_indices: NDArray[np.intp]
) -> Layout:
    return Layout(
        layout.root,
        layout.depth,
        layout.times,
        meters=layout.meters,
        color=tuple(names),
        color_of=color_indices,
    )


def open3d_layout(root: Path) -> Layout | None:
    """Return the layout of Open3D's recorders: `depth/`, `color/` and `intrinsic.json`."""
    depth = list_images(root, "depth")
    if not depth:
        return None
    color = next((found for name in COLOR_FOLDERS if (found := list_images(root, name))), ())
    color_indices = _match_names(depth, color)
    focal, size = None, None
    for name in ("intrinsic.json", "camera_intrinsic.json"):
        if (root / name).is_file():
            focal, size = _intrinsics(root / name)
    return Layout(
        root,
        depth,
        meters=MILLIMETER if focal else None,
        focal=focal,
        focal_size=size,
        color=color if (color_indices != NO_IMAGE).any() else None,
        color_of=color_indices,
    )


def plain_layout(root: Path) -> Layout | None:
    """Return the layout of a folder of PNG files without metadata."""
    names = list_images(root, "")
    return Layout(root, names) if names and is_png(root, names[0]) else None


def list_images(root: Path, folder: str) -> tuple[str, ...]:
    """Return the images in a subfolder of the root, in their order."""
    below = root / folder
    if not below.is_dir():
        return ()
    found = [
        path.relative_to(root).as_posix()
        for path in below.iterdir()
        if path.suffix.lower() in IMAGE_SUFFIXES
        and not path.name.startswith(".")
        and path.is_file()
    ]
    return tuple(sort_naturally(found))


def _match_names(depth: Sequence[str], color: Sequence[str]) -> NDArray[np.intp]:
    """Return the index of the color image with the name of each depth image.

    If no names match and the numbers are equal, images are paired in order.
    """
    indices = {Path(name).stem: index for index, name in enumerate(color)}
    color_indices = np.array(
        [indices.get(Path(name).stem, NO_IMAGE) for name in depth], dtype=np.intp
    )
    if (color_indices == NO_IMAGE).all() and len(depth) == len(color):
        return np.arange(len(depth))
    return color_indices


def _read_list(path: Path) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    rows = _words(path, 2)
    return _times(path, [row[0] for row in rows]), tuple(row[1] for row in rows)


def _words(path: Path, min_words: int) -> list[list[str]]:
    """Return the words of each line that is not a comment."""
    text = read_bytes(path).decode("utf-8", errors="replace").replace(",", " ")
    rows = [line.split() for line in text.splitlines()]
    rows = [row for row in rows if row and not row[0].startswith("#")]
    short = next((row for row in rows if len(row) < min_words), None)
    if short is not None or not rows:
        raise InvalidFileError(
            f"{path} must list a time stamp and an image in each line, but has"
            f" {' '.join(short)[:40]!r}."
            if short
            else f"{path} lists no images."
        )
    return rows


def _times(path: Path, words: Sequence[str]) -> NDArray[np.float64]:
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        raise InvalidFileError(
            f"{path} has lines that do not begin with a time stamp. Correct its first column."
        ) from None


def _intrinsics(path: Path) -> tuple[Focal, tuple[int, int]]:
    """Read the camera of Open3D, whose matrix is in column-major order."""
    try:
        camera = parse_json(read_bytes(path))
        matrix = np.array(camera["intrinsic_matrix"], dtype=np.float64).reshape(3, 3)
        size = int(camera["width"]), int(camera["height"])
        if not (np.isfinite(matrix).all() and min(size) > 0):
            raise ValueError(size)
    except DAMAGE:
        raise InvalidFileError(
            f"{path} is not an Open3D camera with width, height and intrinsic_matrix. Export it"
            " again."
        ) from None
    fx, fy, cx, cy = (float(matrix[index]) for index in ((0, 0), (1, 1), (2, 0), (2, 1)))
    return (fx, fy, cx, cy), size
