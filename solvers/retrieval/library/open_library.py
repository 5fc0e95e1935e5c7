"""Create a library of clips, or open one from a file."""

from collections.abc import Iterable
from pathlib import Path

from ...progress import Progress, unwatched
from ..index import Clip
from . import library_file as files
from .clip_library import ClipLibrary


def build_clip_library(clips: Iterable[Clip], *, progress: Progress = unwatched) -> ClipLibrary:
    """Index clips in a library in memory; `save` writes it to a file.

    Parameters
    ----------
    clips : Clip, any number
        Recordings of bodies: armatures with humanoid roles, or Kinect joints.

    Raises
    ------
    InvalidMotionError
        A clip shows no body, or two clips have the same name.
    """
    library = ClipLibrary(files.create_database())
    library.add(clips, progress=progress)
    return library


def load_clip_library(path: Path | str) -> ClipLibrary:
    """Open the library in a file; nothing in it is ever executed.

    Raises
    ------
    InvalidFileError
        The file is missing, not a library, damaged, or of a newer version.
    """
    path = Path(path)
    return ClipLibrary(files.open_database(path), path)


def open_clip_library(path: Path | str) -> ClipLibrary:
    """Open the library in a file; create an empty one if the file is missing.

    Raises
    ------
    InvalidFileError
        The file is not a library, damaged, of a newer version, or not writable; or the name of
        a new library does not end in .clips or .library.
    """
    path = Path(path)
    if not path.exists() or (path.is_file() and not path.stat().st_size):
        files.create_file(path)
    return load_clip_library(path)
