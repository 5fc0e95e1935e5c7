"""Read depth images from NumPy archives with `depth` and the camera."""

import struct
import zipfile
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...depth_scene import Camera, DepthRecording
from ...errors import InvalidFileError
from ...files import open_regular
from ...npz_members import READABLE, member_header
from ...progress import Progress, unwatched
from ..containers import (
    CHUNK_BYTES,
    MAX_CHECKED_BYTES,
    MAX_DEFLATE_RATIO,
    NUMBERS,
    ByteSlice,
    PackedBytes,
    PlainBytes,
    StoredBytes,
    read_archive,
)
from ..conventions import DEFAULT_FRAME_RATE, MILLIMETER
from .settings import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .stack import ColorStack, DepthStack, check_size

INTRINSICS = ("fx", "fy", "cx", "cy")
LOCAL_HEADER = 30
WITHOUT_HEADER = -15
"""`wbits` of zlib for compressed bytes without a zlib header."""


class _Member(NamedTuple):
    """An array in an archive: its bytes, shape and type."""

    content: StoredBytes
    shape: tuple[int, ...]
    kind: np.dtype[Any]


def is_depth_npz(path: Path, head: bytes) -> bool:
    """Return whether a file is an archive with an array called depth."""
    if head[:4] != b"PK\x03\x04":
        return False
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            return "depth.npy" in archive.namelist()
    except READABLE:
        return b"depth.npy" in head


def read_depth_npz(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read an `.npz` archive of depth images, each on demand.

    Keys: `depth` (frames, height, width), `fx`, `fy`, `cx`, `cy` in pixels, `frame_rate` in
    hertz (default 30), and optionally `color` (frames, height, width, 3) uint8.

    Parameters and errors are those of `read_depth`. Integers are millimeters and floats
    meters, unless a scale is given.
    """
    path = Path(path)
    depth = _member(path, "depth")
    if len(depth.shape) != 3 or not depth.shape[0]:
        raise InvalidFileError(
            f"{path}: its depth has the shape {depth.shape}; it must be (frames, rows,"
            " columns)."
        )
    n_frames, height, width = depth.shape
    check_size(path, height, width)
    default_scale = MILLIMETER if depth.kind.kind in "iu" else 1.0
    stack = DepthStack(
        depth.content, depth.kind.str, (height, width), settings.scale or default_scale
    )
    progress(1.0, "Reading")
    return DepthRecording(
        _camera(path, height, width, settings),
        n_frames,
        settings.frame_rate or _rate(path),
        stack,
        _color(path, depth.shape),
    )


def _member(path: Path, name: str) -> _Member:
    """Find an array in the archive without reading its values."""
    try:
        with open_regular(path) as file, zipfile.ZipFile(file) as archive:
            member = archive.getinfo(f"{name}.npy")
            if member.file_size > MAX_DEFLATE_RATIO * member.compress_size + MAX_DEFLATE_RATIO:
                raise ValueError(name)
            header = member_header(archive, name)
            if header.by_column or header.dtype.kind not in NUMBERS.kinds:
                raise ValueError(header.dtype)
            if member.file_size <= MAX_CHECKED_BYTES:
                _compare_checksum(archive, member)
        content = _content(path, member, header.start, header.n_bytes)
        return _Member(content, header.shape, header.dtype)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except READABLE:
        raise InvalidFileError(
            f"{path} has no readable array called {name}: it is damaged, cut short or of"
            " another kind. Export it again."
        ) from None


def _compare_checksum(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> None:
    """Raise BadZipFile if the checksum at the end of a member does not match."""
    with archive.open(member) as file:
        while file.read(CHUNK_BYTES):
            pass


def _content(path: Path, member: zipfile.ZipInfo, skipped: int, size: int) -> StoredBytes:
    with open_regular(path) as file:
        file.seek(member.header_offset)
        head = file.read(LOCAL_HEADER)
    name, extra = struct.unpack("<HH", head[26:30])
    start = member.header_offset + LOCAL_HEADER + name + extra
    if member.compress_type == zipfile.ZIP_STORED:
        return PlainBytes(path, start + skipped, size)
    compressed = PackedBytes(
        path, start, member.compress_size, member.file_size, WITHOUT_HEADER
    )
    return ByteSlice(compressed, skipped, size)


def _camera(path: Path, height: int, width: int, settings: DepthSettings) -> Camera:
    override = settings.camera(width, height)
    missing = [name for name in INTRINSICS if not _has(path, (name,))]
    if missing and override is not None:
        return override
    if missing:
        raise InvalidFileError(
            f"{path} does not describe its camera: {' and '.join(missing)} must be in it. Add"
            " them, or set the focal lengths fx and fy in pixels, and the center cx and cy"
            " unless it is the middle."
        )
    fx, fy, cx, cy = (_number(path, name) for name in INTRINSICS)
    stored = Camera(fx, fy, cx, cy, width, height)
    return settings.camera(width, height, stored) or stored


def _has(path: Path, names: tuple[str, ...]) -> bool:
    with open_regular(path) as file, zipfile.ZipFile(file) as archive:
        return {f"{name}.npy" for name in names} <= set(archive.namelist())


def _rate(path: Path) -> float:
    return _number(path, "frame_rate") if _has(path, ("frame_rate",)) else DEFAULT_FRAME_RATE


def _number(path: Path, name: str) -> float:
    (array,) = read_archive(path, (name,))
    if array.size != 1:
        raise InvalidFileError(f"{path}: {name} is not a single number.")
    return float(array.reshape(()))


def _color(path: Path, shape: tuple[int, ...]) -> ColorStack | None:
    if not _has(path, ("color",)):
        return None
    color = _member(path, "color")
    if color.shape != (*shape, 3) or color.kind != np.uint8:
        raise InvalidFileError(
            f"{path}: its color has the shape {color.shape} of {color.kind}; for this depth it"
            f" must be {(*shape, 3)} of uint8."
        )
    return ColorStack(color.content, (shape[1], shape[2]))
