"""Read what a depth camera recorded, without being told the format."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from ..errors import InvalidFileError, InvalidMotionError
from ..motion.camera import Camera
from ..motion.depth_recording import DepthRecording
from ..progress import Progress, unwatched
from .depth_mat import is_depth_mat, read_depth_mat
from .depth_npz import is_depth_npz, read_depth_npz
from .depth_raw import is_depth_raw, read_depth_raw

HEAD = 4096


class DepthReader(Protocol):
    """What every reader of depth takes."""

    def __call__(
        self,
        path: Path | str,
        /,
        *,
        scale: float | None = None,
        camera: Camera | None = None,
        frame_rate: float | None = None,
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
    DepthFormat("MATLAB", is_depth_mat, read_depth_mat),
    DepthFormat("raw frames", is_depth_raw, read_depth_raw),
)
"""A new format is a new line here. The last has no mark of its own: it must stay the last."""


def read_depth(
    path: Path | str,
    *,
    scale: float | None = None,
    camera: Camera | None = None,
    frame_rate: float | None = None,
    progress: Progress = unwatched,
) -> DepthRecording:
    """Read a recording of depth of any format known here, told by what it holds.

    Only what describes the pictures is read now; each picture is when it is asked for.

    Parameters
    ----------
    path : Path or str
        See docs/formats/depth.md.
    scale : float, metres per unit of a pixel, or None
        None takes the file's word, or what its format means.
    camera : Camera or None
        None takes the file's word, or the camera that its format means.
    frame_rate : float, hertz, or None
        None takes the file's word, or 30.
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
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    known = depth_format_of(path)
    if known is None:
        names = ", ".join(each.name for each in DEPTH_FILES)
        raise InvalidFileError(f"{path} holds no depth of a known format ({names}).")
    try:
        return known.read(
            path, scale=scale, camera=camera, frame_rate=frame_rate, progress=progress
        )
    except InvalidMotionError as error:  # Such as a camera that sees nothing.
        raise InvalidFileError(f"{path}: {error}") from None


def depth_format_of(path: Path | str) -> DepthFormat | None:
    """Tell which format of depth a file or folder has; None for none that is known.

    Raises
    ------
    InvalidFileError
        The file is missing, or cannot be read.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise InvalidFileError(f"{path} cannot be read ({error.strerror}).") from None
    return next((known for known in DEPTH_FILES if known.fits(path, head)), None)
