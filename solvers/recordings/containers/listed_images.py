"""Open images that a recording lists: only regular files within its folder."""

import errno
import os
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePath
from typing import Any, BinaryIO

from ...errors import InvalidFileError
from ...files import DAMAGE, open_regular
from .names import shown

MAX_COLOR_RATIO, MAX_COLOR_PIXELS = 16, 8192
"""Maximum columns or rows of a color image: relative to the depth image, and absolute."""
FORMATS = ("PNG", "JPEG", "PPM", "BMP")
"""Pillow formats allowed for color; others start programs or need much memory."""


def open_listed(root: Path, name: str) -> BinaryIO:
    """Open a file that a recording in a folder lists.

    Raises
    ------
    InvalidFileError
        It is outside the folder after links are followed.
    OSError
        It is missing, or not a regular file (a pipe, a device or a folder).
    """
    path = PurePath(name)
    # Refuse names of other machines before Windows connects to them.
    if path.anchor or ".." in path.parts or not _is_inside(root, name):
        raise InvalidFileError(
            f"{root} lists the image {shown(name)}, which is outside of it. Copy the image"
            " into the folder."
        )
    return open_regular(root / name)


def is_listed(root: Path, name: str) -> bool:
    """Return whether a listed file exists; raise as `open_listed` if it is outside."""
    try:
        open_listed(root, name).close()
    except OSError:
        return False
    return True


@contextmanager
def open_listed_image(
    root: Path, name: str, max_size: tuple[int, int], formats: tuple[str, ...] = FORMATS
) -> Iterator[Any]:
    """Yield a listed image as Pillow opens it, without decompressing it.

    Parameters
    ----------
    root : Path
    name : str
    max_size : (int, int)
        Maximum columns and rows.
    formats : tuple of str
        Allowed formats, as Pillow calls them.

    Raises
    ------
    InvalidFileError
        It is outside the folder, missing, damaged or too large.
    """
    try:
        with (
            open_listed(root, name) as file,
            open_bounded_image(root / name, file, max_size, formats) as image,
        ):
            yield image
    except InvalidFileError:
        raise
    except DAMAGE:
        raise InvalidFileError(
            f"{root / name} is missing or damaged. Copy or export it again."
        ) from None


@contextmanager
def open_bounded_image(
    path: Path, content: BinaryIO, max_size: tuple[int, int], formats: tuple[str, ...]
) -> Iterator[Any]:
    """Yield an image of a file; raise InvalidFileError if its header has too many pixels."""
    from PIL import Image

    too_large = InvalidFileError(
        f"{path} has an image of more than {max_size[0]} x {max_size[1]} pixels. Export it"
        " smaller."
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(content, formats=formats)
    except Image.DecompressionBombError:
        raise too_large from None
    with image:
        if image.width > max_size[0] or image.height > max_size[1]:
            raise too_large
        yield image


def max_color_size(shape: tuple[int, int]) -> tuple[int, int]:
    """Return the maximum columns and rows of color images for depth of (rows, columns)."""
    height, width = (min(MAX_COLOR_RATIO * size, MAX_COLOR_PIXELS) for size in shape)
    return width, height


def _is_inside(root: Path, name: str) -> bool:
    try:
        file, folder = os.path.realpath(root / name), os.path.realpath(root)
        return os.path.commonpath([file, folder]) == folder
    except ValueError:  # Not a valid file name, or on another drive.
        raise OSError(errno.EINVAL, "it is not a valid file name", name) from None
