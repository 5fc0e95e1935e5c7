"""Create a library of clips, or open one from a file."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from ...errors import InvalidFileError
from ...files import real_path
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


def libraries_in(files_or_folders: Sequence[Path]) -> list[Path]:
    """Return the named libraries, and those in each named folder by name, each once.

    Raises
    ------
    InvalidFileError
        A folder has no library.
    """
    found = dict[Path, Path]()
    for named in files_or_folders:
        inside = [named]
        if named.is_dir():
            listed = sorted(named.iterdir())
            inside = [path for path in listed if path.suffix.lower() in files.SUFFIXES]
        if not inside:
            raise InvalidFileError(f"There is no clip library in the folder {named}.")
        for path in inside:
            found.setdefault(real_path(path), path)
    return [*found.values()]


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
