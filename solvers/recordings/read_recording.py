"""Read a recording of any supported format."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple, Protocol

from ..depth_scene import DepthRecording
from ..errors import InvalidFileError, InvalidMotionError
from ..faults import attempt
from ..files import open_regular, unreadable
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched
from .containers import BYTE_ORDER_MARK, check_folder_access, files_below, is_c3d, is_folder
from .conventions import check_scale
from .depth_files import DepthSettings, detect_depth_format, is_depth_folder, read_depth
from .joint_files import (
    is_azure_csv,
    is_azure_json,
    is_irds,
    is_joint_csv,
    is_joint_json,
    is_kinect_csv,
    is_msr_action3d,
    is_npy,
    is_ntu_skeleton,
    is_ui_prmd,
    read_azure_csv,
    read_azure_json,
    read_irds,
    read_joint_csv,
    read_joint_json,
    read_kinect_csv,
    read_msr_action3d,
    read_ntu_skeleton,
    read_ui_prmd,
)
from .marker_files import read_c3d, read_trc
from .numpy_files import read_npy
from .refused_files import REFUSALS
from .skeleton_files import (
    is_kimodo,
    is_mvnx,
    is_smpl,
    read_acclaim,
    read_bvh,
    read_kimodo,
    read_mvnx,
    read_smpl,
)

HEAD = 4096


class Reader(Protocol):
    """Signature of the reader of a format."""

    def __call__(
        self, path: Path | str, /, *, scale: float | None = None, progress: Progress = unwatched
    ) -> Motion | Tracks | JointRecording:
        """Read a file."""


class Format(NamedTuple):
    """A supported format, with its reader and its detection from the first bytes."""

    name: str
    fits: Callable[[bytes], bool]
    read: Reader
    has_skeleton: bool = False
    """Whether it contains the motion of a skeleton; otherwise points."""
    is_refused: bool = False
    """Whether it is recognized only for a better sentence."""
    lacks_bones: bool = False
    """Whether it may hold the rotations of a body without lengths (`smpl_body`)."""


def _is_bvh(head: bytes) -> bool:
    return head.lstrip()[:9].upper() == b"HIERARCHY"


def _is_acclaim(head: bytes) -> bool:
    text = re.sub(rb"(?m)^\s*#.*$", b"", head).lstrip()
    return re.match(rb"(?i):(FULLY-SPECIFIED|DEGREES|RADIANS)|1\s+root\s", text) is not None


def _is_trc(head: bytes) -> bool:
    """Detect TRC; some programs omit the first line, or write it in lower case."""
    return re.match(rb"(?i)[\s\"]*(PathFileType|DataRate\W+CameraRate)\b", head) is not None


FORMATS = (
    Format("BVH", _is_bvh, read_bvh, has_skeleton=True),
    Format("Acclaim AMC", _is_acclaim, read_acclaim, has_skeleton=True),
    *(Format(each.name, each.fits, each.read, is_refused=True) for each in REFUSALS),
    Format("SMPL parameters", is_smpl, read_smpl, has_skeleton=True, lacks_bones=True),
    Format("Kimodo", is_kimodo, read_kimodo, has_skeleton=True),
    Format("Xsens MVNX", is_mvnx, read_mvnx, has_skeleton=True),
    Format("C3D", is_c3d, read_c3d),
    Format("TRC", _is_trc, read_trc),
    Format("IRDS", is_irds, read_irds),
    Format("Kinect v2 CSV", is_kinect_csv, read_kinect_csv),
    Format("Azure Kinect CSV", is_azure_csv, read_azure_csv),
    Format("Azure Kinect JSON", is_azure_json, read_azure_json),
    Format("NTU RGB+D", is_ntu_skeleton, read_ntu_skeleton),
    Format("MSR Action3D", is_msr_action3d, read_msr_action3d),
    Format("UI-PRMD", is_ui_prmd, read_ui_prmd),
    Format("freemocap", is_npy, read_npy, lacks_bones=True),
    Format("joint CSV", is_joint_csv, read_joint_csv),
    Format("joint JSON", is_joint_json, read_joint_json),
)
"""Supported formats; add a line here for a new one."""


def read_recording(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion | Tracks | JointRecording | DepthRecording:
    """Read a recording of any supported format, detected from the content.

    Parameters
    ----------
    path : Path or str
        BVH; AMC with the ASF of the actor next to it; C3D; TRC; joints of depth cameras; depth
        images (docs/formats).
    scale : float, meters per unit of the file, or None
        None: the default of the format.
    progress : Progress

    Returns
    -------
    Motion, Tracks or JointRecording
        In meters, Z up; NaN where not observed.
    DepthRecording
        Depth images of a camera; see `read_depth` for more options.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or of an unsupported format.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    if is_depth_recording(path):
        return read_depth(path, DepthSettings(scale=scale or 0.0), progress=progress)
    return read_tracked(path, scale=scale, progress=progress)


def is_depth_recording(path: Path | str) -> bool:
    """Whether a file or folder contains depth images of a supported format.

    Raises InvalidFileError if it is missing or unreadable.
    """
    return detect_format(path) is None and detect_depth_format(path) is not None


def read_tracked(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion | Tracks | JointRecording:
    """Read a recording as `read_recording` does, without depth images.

    Raises
    ------
    InvalidFileError
        Also for a depth recording, which has no tracked motion yet.
    """
    return read_format(path, detect_format(path), scale, progress)


def read_format(
    path: Path | str, format_: Format | None, scale: float | None, progress: Progress
) -> Motion | Tracks | JointRecording:
    """Read a file of a detected format as `read_tracked` does; refuse None."""
    if format_ is not None:
        try:
            return format_.read(path, scale=scale, progress=progress)
        except InvalidMotionError as error:  # valid format, but not a valid recording
            raise InvalidFileError(f"{path}: {error}") from None
    if detect_depth_format(path) is not None:
        raise InvalidFileError(
            f"{path} has depth images but no motion yet. Track the actor in it first."
        )
    if Path(path).is_dir():
        raise InvalidFileError(f"{path} is a folder without depth images. Choose a file in it.")
    names = ", ".join(each.name for each in FORMATS if not each.is_refused)
    raise InvalidFileError(
        f"{path} is of no known format ({names}). Export it as one of these first."
    )


def detect_format(path: Path | str) -> Format | None:
    """Detect the format of a file from its first bytes; None if it is not supported.

    For depth images see `detect_depth_format`.

    Raises
    ------
    InvalidFileError
        The file is missing or unreadable.
    """
    if Path(path).is_dir():
        check_folder_access(Path(path))
        return None
    try:
        with open_regular(path) as file:
            head = file.read(HEAD).removeprefix(BYTE_ORDER_MARK)
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise unreadable(path, error) from None
    return next((format_ for format_ in FORMATS if format_.fits(head)), None)


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


def read_motion_or_tracks(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion | Tracks:
    """Read a recording as `read_tracked` does; return the joints of a camera as points."""
    recording = read_tracked(path, scale=scale, progress=progress)
    return recording.tracks if isinstance(recording, JointRecording) else recording
