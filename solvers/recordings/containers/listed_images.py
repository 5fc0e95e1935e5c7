"""Images that a recording names: opened only below its folder, and only if they are files."""

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
"""Columns or rows of a color image, at most: so many times those of depth, and in all."""
FORMATS = ("PNG", "JPEG", "PPM", "BMP")
"""Those of Pillow that color may have; others start programs, or are large to read."""


def open_listed(root: Path, name: str) -> BinaryIO:
    """Open a file that a recording in a folder names.

    Raises
    ------
    InvalidFileError
        It lies outside of the folder, once links are followed.
    OSError
        It is missing, or a pipe, a device or a folder, which are not waited for.
    """
    path = PurePath(name)
    # Names of other machines are refused before Windows asks these for them.
    if path.anchor or ".." in path.parts or not _is_inside(root, name):
        raise InvalidFileError(
            f"{root} names the image {shown(name)}, which lies outside of it. Copy the image"
            " into the folder."
        )
    return open_regular(root / name)


def is_listed(root: Path, name: str) -> bool:
    """Whether a recording names a file that is there; raises as `open_listed` if outside."""
    try:
        open_listed(root, name).close()
    except OSError:
        return False
    return True


@contextmanager
def listed_image(
    root: Path, name: str, largest: tuple[int, int], formats: tuple[str, ...] = FORMATS
) -> Iterator[Any]:
    """Yield the image that a recording names, as Pillow opens it: nothing is unpacked yet.

    Parameters
    ----------
    root : Path
    name : str
    largest : (int, int)
        Columns and rows that it may have.
    formats : tuple of str
        That it may have, as Pillow calls them.

    Raises
    ------
    InvalidFileError
        It lies outside of the folder, is missing or damaged, or too large.
    """
    try:
        with (
            open_listed(root, name) as file,
            bounded_image(root / name, file, largest, formats) as image,
        ):
            yield image
    except InvalidFileError:
        raise
    except DAMAGE:
        raise InvalidFileError(
            f"{root / name} is missing or damaged. Copy or export it again."
        ) from None


@contextmanager
def bounded_image(
    path: Path, content: BinaryIO, largest: tuple[int, int], formats: tuple[str, ...]
) -> Iterator[Any]:
    """Yield an image of a file; raises InvalidFileError if it announces too many pixels."""
    from PIL import Image

    too_large = InvalidFileError(
        f"{path} has an image of more than {largest[0]} x {largest[1]} pixels. Export it"
        " smaller."
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            image = Image.open(content, formats=formats)
    except Image.DecompressionBombError:
        raise too_large from None
    with image:
        if image.width > largest[0] or image.height > largest[1]:
            raise too_large
        yield image


def largest_color(shape: tuple[int, int]) -> tuple[int, int]:
    """Return the columns and rows that color beside depth of (rows, columns) may have."""
    height, width = (min(MAX_COLOR_RATIO * size, MAX_COLOR_PIXELS) for size in shape)
    return width, height


def _is_inside(root: Path, name: str) -> bool:
    try:
        whole, folder = os.path.realpath(root / name), os.path.realpath(root)
        return os.path.commonpath([whole, folder]) == folder
    except ValueError:  # No name of a file, or on another drive.
        raise OSError(errno.EINVAL, "it is no name of a file", name) from None
