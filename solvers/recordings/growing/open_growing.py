"""Open a depth recording that grows."""

from pathlib import Path

from ...errors import InvalidFileError
from ..depth_files import DEFAULT_DEPTH_SETTINGS, DepthSettings
from .growing_folder import GrowingFolder
from .growing_mkv import GrowingMkv
from .growing_source import GrowingDepth

MKV = ".mkv"


def open_growing(
    path: Path | str, settings: DepthSettings = DEFAULT_DEPTH_SETTINGS
) -> GrowingDepth:
    """Return a folder of depth images, or an `.mkv`, that is read while it grows.

    Parameters
    ----------
    path : Path or str
        It need not exist yet, but the folder that contains it must.
    settings : DepthSettings

    Raises
    ------
    InvalidFileError
        It is a file of another kind, or in a folder that does not exist.
    """
    path = Path(path)
    if not path.parent.is_dir():
        raise InvalidFileError(f"There is no folder {path.parent} to wait for {path.name} in.")
    if path.suffix.lower() == MKV:
        return GrowingMkv(path, settings)
    if path.is_file():
        raise InvalidFileError(
            f"{path} cannot be read while it grows. Follow a folder of 16-bit PNG images or an"
            " .mkv, or capture the file when it is complete."
        )
    return GrowingFolder(path, settings)
