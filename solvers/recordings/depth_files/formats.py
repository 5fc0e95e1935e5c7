"""Read what a depth camera recorded, without being told the format."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from ...depth_scene import DepthRecording
from ...errors import InvalidFileError, InvalidMotionError
from ...files import open_regular, unreadable
from ...progress import Progress, unwatched
from ..containers import check_folder_access
from .camera_orientation import rotate_upright
from .folder import layout_of, read_depth_folder
from .mat import is_depth_mat, read_depth_mat
from .mkv import is_depth_mkv, read_depth_mkv
from .npz import is_depth_npz, read_depth_npz
from .raw import is_depth_raw, read_depth_raw
from .settings import DEFAULT_DEPTH_SETTINGS, CameraOrientation, DepthSettings

HEAD = 4096


class DepthReader(Protocol):
    """What every reader of depth takes."""

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
    """A format of depth that can be read, and how to tell it by path and first bytes."""

    name: str
    fits: Callable[[Path, bytes], bool]
    read: DepthReader


DEPTH_FILES = (
    DepthFormat("NPZ", is_depth_npz, read_depth_npz),
    DepthFormat("Azure Kinect MKV", is_depth_mkv, read_depth_mkv),
    DepthFormat("MATLAB", is_depth_mat, read_depth_mat),
    DepthFormat("raw frames", is_depth_raw, read_depth_raw),
)
"""A new format is a new line here. The last has no mark of its own: it must stay the last."""

FOLDER = DepthFormat(
    "folder of 16-bit PNG", lambda path, head: path.is_dir(), read_depth_folder
)


def read_depth(
    path: Path | str,
    settings: DepthSettings = DEFAULT_DEPTH_SETTINGS,
    *,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a recording of depth of any format known here, told by what it holds.

    Only what describes the pictures is read now; each picture is when it is asked for.

    Parameters
    ----------
    path : Path or str
        A file or a folder: see docs/formats/depth.md.
    settings : DepthSettings
        What the files leave open. What is given counts more than what they say.
    progress : Progress
        Told how much is read, and what was amiss.

    Returns
    -------
    DepthRecording
        May be pickled: another process then reads the same pictures.

    Raises
    ------
    InvalidFileError
        What is there is missing, damaged, holds no depth, or does not tell the camera.
    SolveCancelled
        Raised by `progress`.
    """
    known = detect_depth_format(path)
    if known is None:
        names = ", ".join(each.name for each in (*DEPTH_FILES, FOLDER))
        raise InvalidFileError(f"{path} holds no depth of a known format ({names}).")
    try:
        recording = known.read(path, settings, progress=progress)
    except InvalidMotionError as error:  # Such as a camera that sees nothing.
        raise InvalidFileError(f"{path}: {error}") from None
    held = CameraOrientation.UPRIGHT if known is FOLDER else settings.held
    return rotate_upright(recording, held, settings.mirrored)


def detect_depth_format(path: Path | str) -> DepthFormat | None:
    """Tell which format of depth a file or folder has; None for none that is known.

    Raises
    ------
    InvalidFileError
        The file is missing, or cannot be read.
    """
    path = Path(path)
    if path.is_dir():
        check_folder_access(path)
        return FOLDER if layout_of(path) is not None else None
    try:
        with open_regular(path) as file:
            head = file.read(HEAD)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise unreadable(path, error) from None
    return next((known for known in DEPTH_FILES if known.fits(path, head)), None)
