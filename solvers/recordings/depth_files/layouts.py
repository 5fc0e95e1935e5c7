"""How folders of depth pictures are laid out by those who record them."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import DAMAGE
from ...json_text import parse_json
from ..containers import is_png, read_bytes
from .image_frames import match_times, sort_naturally
from .images import NONE
from .settings import CameraOrientation
from .stack import MILLIMETER

Focal = tuple[float, float, float, float]

TUM_UNIT = 1.0 / 5000.0
IMAGE_SUFFIXES = (".png", ".jpg", ".jpeg")
COLOR_FOLDERS = ("color", "rgb", "image")


@dataclass(frozen=True, eq=False)
class Layout:
    """What a folder tells of its pictures.

    Attributes
    ----------
    root : Path
    depth : tuple of str
        Files of depth, below the root, in their order.
    times : float array, shape (n_files,), seconds, or None
    rate : float, hertz, or None
        Where there are no times.
    metres : float, or None
        Metres in one unit of a pixel; None where nobody knows.
    focal : (fx, fy, cx, cy), pixels, or None
    focal_size : (int, int), or None
        Width and height of the pictures for which that holds; None: those of depth.
    color : tuple of str, or None
    color_of : int array, shape (n_files,), or None
        Which file of colour each file of depth has; -1: none.
    confidence : tuple of str, or None
    held : CameraOrientation
    remarks : tuple of str
    """

    root: Path
    depth: tuple[str, ...]
    times: NDArray[np.float64] | None = None
    rate: float | None = None
    metres: float | None = None
    focal: Focal | None = None
    focal_size: tuple[int, int] | None = None
    color: tuple[str, ...] | None = None
    color_of: NDArray[np.intp] | None = None
    confidence: tuple[str, ...] | None = None
    held: CameraOrientation = CameraOrientation.UPRIGHT
    remarks: tuple[str, ...] = field(default=())


def tum_layout(root: Path) -> Layout | None:
    """Lay out a folder as TUM RGB-D: `depth.txt` and `rgb.txt`, or `associations.txt`."""
    if (root / "depth.txt").is_file():
        times, names = _read_list(root / "depth.txt")
        layout = Layout(root, names, times, metres=TUM_UNIT)
        if not (root / "rgb.txt").is_file():
            return layout
        color_times, color = _read_list(root / "rgb.txt")
        return _with_color(layout, color, match_times(times, color_times))
    for known in ("associations.txt", "associates.txt", "associated.txt"):
        if (root / known).is_file():
            return _associated(root, root / known)
    return None


def _associated(root: Path, path: Path) -> Layout:
    rows = _words(path, 4)
    if not rows:
        raise InvalidFileError(f"{path} names no pictures.")
    first_is_depth = "depth" in rows[0][1] and "depth" not in rows[0][3]
    depth, color = (0, 2) if first_is_depth else (2, 0)
    layout = Layout(
        root,
        tuple(row[depth + 1] for row in rows),
        _times(path, [row[depth] for row in rows]),
        metres=TUM_UNIT,
    )
    return _with_color(layout, [row[color + 1] for row in rows], np.arange(len(rows)))


def _with_color(layout: Layout, names: Sequence[str], of: NDArray[np.intp]) -> Layout:
    return Layout(
        layout.root,
        layout.depth,
        layout.times,
        metres=layout.metres,
        color=tuple(names),
        color_of=of,
    )


def open3d_layout(root: Path) -> Layout | None:
    """Lay out a folder as Open3D's recorders do: `depth/`, `color/` and `intrinsic.json`."""
    depth = list_images(root, "depth")
    if not depth:
        return None
    color = next((found for name in COLOR_FOLDERS if (found := list_images(root, name))), ())
    of = _match_names(depth, color)
    focal, size = None, None
    for name in ("intrinsic.json", "camera_intrinsic.json"):
        if (root / name).is_file():
            focal, size = _intrinsics(root / name)
    return Layout(
        root,
        depth,
        metres=MILLIMETER if focal else None,
        focal=focal,
        focal_size=size,
        color=color if (of != NONE).any() else None,
        color_of=of,
    )


def plain_layout(root: Path) -> Layout | None:
    """Lay out a folder that holds PNG files and says nothing of them."""
    names = list_images(root, "")
    return Layout(root, names) if names and is_png(root, names[0]) else None


def list_images(root: Path, folder: str) -> tuple[str, ...]:
    """Return the pictures in a folder of the root, in their order."""
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
    """Return which picture of colour is called as each of depth; in order if none is."""
    places = {Path(name).stem: place for place, name in enumerate(color)}
    of = np.array([places.get(Path(name).stem, NONE) for name in depth], dtype=np.intp)
    if (of == NONE).all() and len(depth) == len(color):
        return np.arange(len(depth))
    return of


def _read_list(path: Path) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    rows = _words(path, 2)
    return _times(path, [row[0] for row in rows]), tuple(row[1] for row in rows)


def _words(path: Path, least: int) -> list[list[str]]:
    """Return the words of each line that is no comment."""
    text = read_bytes(path).decode("utf-8", errors="replace").replace(",", " ")
    rows = [line.split() for line in text.splitlines()]
    rows = [row for row in rows if row and not row[0].startswith("#")]
    short = next((row for row in rows if len(row) < least), None)
    if short is not None or not rows:
        raise InvalidFileError(
            f"{path} should name a time stamp and a picture in each line, but has"
            f" {' '.join(short)[:40]!r}."
            if short
            else f"{path} names no pictures."
        )
    return rows


def _times(path: Path, words: Sequence[str]) -> NDArray[np.float64]:
    try:
        return np.array([float(word) for word in words])
    except ValueError:
        raise InvalidFileError(
            f"{path} has lines that begin with no time stamp. Mend its first column."
        ) from None


def _intrinsics(path: Path) -> tuple[Focal, tuple[int, int]]:
    """Read the camera of Open3D: its matrix stands column by column."""
    try:
        told = parse_json(read_bytes(path))
        matrix = np.array(told["intrinsic_matrix"], dtype=np.float64).reshape(3, 3)
        size = int(told["width"]), int(told["height"])
        if not (np.isfinite(matrix).all() and min(size) > 0):
            raise ValueError(size)
    except DAMAGE:
        raise InvalidFileError(
            f"{path} is no camera as Open3D writes it: width, height and intrinsic_matrix."
        ) from None
    fx, fy, cx, cy = (float(matrix[place]) for place in ((0, 0), (1, 1), (2, 0), (2, 1)))
    return (fx, fy, cx, cy), size
