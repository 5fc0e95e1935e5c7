"""Find the recordings in folders."""

from collections.abc import Callable
from pathlib import Path

from ..faults import attempt
from .containers import files_below, is_folder
from .depth_files import is_depth_folder
from .formats import detect_format
from .read_recording import is_depth_recording


def recordings_in(folder: Path) -> list[Path]:
    """Return the recordings in a folder and its subfolders, sorted by name.

    Skip hidden files and folders, and skeletons without motion. Include files and folders that
    cannot be opened: the reader reports the reason.
    """
    return [path for path in files_below(folder) if may_contain_motion(path)]


def may_contain_motion(path: Path) -> bool:
    """Whether a file is a recording by its first bytes, or cannot be opened."""
    format_ = attempt(path, detect_format, path)
    return format_ is not None and not getattr(format_, "is_refused", False)


def depth_takes_in(
    folder: Path, is_take: Callable[[Path], bool] = is_depth_folder
) -> list[Path]:
    """Return the depth recordings in a folder and below, by name; or the folder itself.

    A folder of images is one recording and is not searched. Skip hidden files and folders, and
    links to folders. Include files and folders that cannot be opened: the reader reports the
    reason.

    Parameters
    ----------
    folder : Path
    is_take : callable
        Returns whether a folder is one recording.
    """
    paths = files_below(folder, is_take)
    return [
        path for path in paths if is_folder(path) or attempt(path, is_depth_recording, path)
    ]
