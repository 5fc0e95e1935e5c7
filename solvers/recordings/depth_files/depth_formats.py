"""Read depth recordings of any supported format, detected from the content."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from ...depth_scene import DepthRecording
from ...errors import InvalidFileError, InvalidMotionError
from ...files import open_regular, unreadable_error
from ...progress import Progress, unwatched
from ..containers import check_folder_access
from .camera_orientation import rotate_upright
from .folder import detect_layout, read_depth_folder
from .mat import is_depth_mat, read_depth_mat
from .mkv import is_depth_mkv, read_depth_mkv
from .npz import is_depth_npz, read_depth_npz
from .raw import is_depth_raw, read_depth_raw
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings

HEAD_BYTES = 4096


class DepthReader(Protocol):
    """Signature of a reader of depth recordings."""

    def __call__(
        self,
        path: Path | str,
        settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
        /,
        *,
        progress: Progress = unwatched,
    ) -> DepthRecording:
        """Read a file or a folder."""


class DepthFormat(NamedTuple):
    """A supported depth format, with its reader and its detection from path and first bytes."""

    name: str
    fits: Callable[[Path, bytes], bool]
    read: DepthReader


DEPTH_FILES = (
    DepthFormat("NPZ", is_depth_npz, read_depth_npz),
    DepthFormat("Azure Kinect MKV", is_depth_mkv, read_depth_mkv),
    DepthFormat("MATLAB", is_depth_mat, read_depth_mat),
    DepthFormat("raw frames", is_depth_raw, read_depth_raw),
)
"""Supported formats; add a line here for a new one. Raw frames have no signature: last."""

FOLDER = DepthFormat(
    "folder of 16-bit PNG", lambda path, head: path.is_dir(), read_depth_folder
)


def read_depth(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a depth recording of any supported format, detected from the content.

    Only the description is read now; each image is read on demand.

    Parameters
    ----------
    path : Path or str
        A file or a folder: see docs/formats/depth.md.
    settings : DepthSettings
        Values that the files do not store. Given settings override the file.
    progress : Progress
        Receives the fraction that is read, and messages on problems.

    Returns
    -------
    DepthRecording
        It can be pickled, so that another process reads the same images.

    Raises
    ------
    InvalidFileError
        The file or folder is missing or damaged, has no depth, or lacks the camera.
    SolveCancelled
        Raised by `progress`.
    """
    depth_format = detect_depth_format(path)
    if depth_format is None:
        names = ", ".join(each.name for each in (*DEPTH_FILES, FOLDER))
        raise InvalidFileError(f"{path} holds no depth of a known format ({names}).")
    try:
        recording = depth_format.read(path, settings, progress=progress)
    except InvalidMotionError as error:  # for example a camera without pixels
        raise InvalidFileError(f"{path}: {error}") from None
    held = CameraOrientation.UPRIGHT if depth_format is FOLDER else settings.held
    return rotate_upright(recording, held, settings.mirrored)


def detect_depth_format(path: Path | str) -> DepthFormat | None:
    """Detect the depth format of a file or folder; None if it is not supported.

    Raises
    ------
    InvalidFileError
        The file is missing or unreadable.
    """
    path = Path(path)
    if path.is_dir():
        check_folder_access(path)
        return FOLDER if detect_layout(path) is not None else None
    try:
        with open_regular(path) as file:
            head = file.read(HEAD_BYTES)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise unreadable_error(path, error) from None
    return next(
        (depth_format for depth_format in DEPTH_FILES if depth_format.fits(path, head)), None
    )
