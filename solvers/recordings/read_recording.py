"""Read a recording of any supported format."""

import re
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from ..depth_scene import DepthRecording
from ..errors import InvalidFileError, InvalidMotionError
from ..files import open_regular, unreadable
from ..motion import JointRecording, Motion, Tracks
from ..progress import Progress, unwatched, within
from .containers import (
    BYTE_ORDER_MARK,
    check_folder_access,
    is_c3d,
    json_length,
)
from .conventions import Bodies, Body, check_scale
from .depth_files import DepthSettings, detect_depth_format, read_depth
from .format import Format, Tracked
from .joint_files import (
    is_azure_csv,
    is_azure_json,
    is_irds,
    is_joint_csv,
    is_joint_json,
    is_kinect_csv,
    is_mediapipe_csv,
    is_mediapipe_json,
    is_msr_action3d,
    is_npy,
    is_ntu_skeleton,
    is_nuitrack_csv,
    is_nuitrack_json,
    is_ui_prmd,
    is_zed_json,
    open_azure_csv,
    open_azure_json,
    open_irds,
    open_joint_csv,
    open_joint_json,
    open_ntu_skeleton,
    read_azure_csv,
    read_azure_json,
    read_irds,
    read_joint_csv,
    read_joint_json,
    read_kinect_csv,
    read_mediapipe_csv,
    read_mediapipe_json,
    read_msr_action3d,
    read_ntu_skeleton,
    read_nuitrack_csv,
    read_nuitrack_json,
    read_ui_prmd,
    read_zed_json,
)
from .marker_files import (
    is_motive_csv,
    is_qualisys_tsv,
    is_vicon_csv,
    open_c3d,
    read_c3d,
    read_motive_csv,
    read_qualisys_tsv,
    read_trc,
    read_vicon_csv,
)
from .numpy_files import read_npy
from .refused_files import REFUSALS
from .skeleton_files import (
    is_kimodo,
    is_mvnx,
    is_smpl,
    is_vrma,
    open_mvnx,
    open_smpl,
    read_acclaim,
    read_bvh,
    read_kimodo,
    read_mvnx,
    read_smpl,
    read_vrma,
)

HEAD = 4096
MAX_JSON_BYTES = 1 << 22
"""Of a glTF file, read to see what it holds."""
OPENING_FRACTION = 0.9
"""Fraction of the time that passes until the bodies are known, in formats with several."""


Result = TypeVar("Result")


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
    Format("VRM animation", is_vrma, read_vrma, has_skeleton=True),
    *(Format(each.name, each.fits, each.read, is_refused=True) for each in REFUSALS),
    Format("SMPL parameters", is_smpl, read_smpl, has_skeleton=True, open=open_smpl),
    Format("Kimodo", is_kimodo, read_kimodo, has_skeleton=True),
    Format("Xsens MVNX", is_mvnx, read_mvnx, has_skeleton=True, open=open_mvnx),
    Format("C3D", is_c3d, read_c3d, open=open_c3d),
    Format("TRC", _is_trc, read_trc),
    Format("OptiTrack CSV", is_motive_csv, read_motive_csv),
    Format("Qualisys TSV", is_qualisys_tsv, read_qualisys_tsv),
    Format("Vicon CSV", is_vicon_csv, read_vicon_csv),
    Format("IRDS", is_irds, read_irds, open=open_irds),
    Format("Kinect v2 CSV", is_kinect_csv, read_kinect_csv),
    Format("Azure Kinect CSV", is_azure_csv, read_azure_csv, open=open_azure_csv),
    Format("Azure Kinect JSON", is_azure_json, read_azure_json, open=open_azure_json),
    Format("NTU RGB+D", is_ntu_skeleton, read_ntu_skeleton, open=open_ntu_skeleton),
    Format("MSR Action3D", is_msr_action3d, read_msr_action3d),
    Format("UI-PRMD", is_ui_prmd, read_ui_prmd),
    Format("freemocap", is_npy, read_npy),
    Format("ZED JSON", is_zed_json, read_zed_json),
    Format("Nuitrack CSV", is_nuitrack_csv, read_nuitrack_csv),
    Format("Nuitrack JSON", is_nuitrack_json, read_nuitrack_json),
    Format("MediaPipe CSV", is_mediapipe_csv, read_mediapipe_csv),
    Format("MediaPipe JSON", is_mediapipe_json, read_mediapipe_json),
    Format("joint CSV", is_joint_csv, read_joint_csv, open=open_joint_csv),
    Format("joint JSON", is_joint_json, read_joint_json, open=open_joint_json),
)
"""Supported formats; add a line here for a new one."""


def read_recording(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Motion | Tracks | JointRecording | DepthRecording:
    """Read a recording of any supported format, detected from the content.

    Parameters
    ----------
    path : Path or str
        BVH; AMC with the ASF of the actor next to it; C3D; TRC; joints of depth cameras; depth
        images (docs/formats).
    scale : float, meters per unit of the file, or None
        None: the default of the format.
    body : str, optional
        Name or number of one of several bodies (`list_bodies`); by default the person in most
        frames. A message to `progress` names the others.
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
    InvalidSettingError
        The scale is not positive, or there is no such body.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    if is_depth_recording(path):
        return read_depth(path, DepthSettings(scale=scale or 0.0), progress=progress)
    return read_tracked(path, scale=scale, body=body, progress=progress)


def list_bodies(path: Path | str, *, progress: Progress = unwatched) -> tuple[Body, ...]:
    """Return the bodies to choose from in a recording; empty where there is no choice.

    False detections are left out. Raises InvalidFileError as `read_tracked` does.
    """
    bodies = open_bodies(path, progress=progress)
    return tuple(bodies.listed[each] for each in bodies.offered)


def is_depth_recording(path: Path | str) -> bool:
    """Whether a file or folder contains depth images of a supported format.

    Raises InvalidFileError if it is missing or unreadable.
    """
    return detect_format(path) is None and detect_depth_format(path) is not None


def read_tracked(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Tracked:
    """Read a recording as `read_recording` does, without depth images.

    Raises
    ------
    InvalidFileError
        Also for a depth recording, which has no tracked motion yet.
    """
    bodies = open_bodies(path, scale=scale, progress=within(progress, 0.0, OPENING_FRACTION))
    start = OPENING_FRACTION if bodies.listed else 0.0
    return bodies.read_one(body, within(progress, start, 1.0))


def open_bodies(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Tracked]:
    """List the bodies of a recording, of which each can then be read.

    Raises
    ------
    InvalidFileError
        As `read_tracked`. Of a format with one body, damage is found when that is read.
    """
    format_ = detect_format(path)
    if format_ is None:
        raise _unknown_format(path)
    if format_.open is None:
        read = partial(format_.read, path, scale=scale)
        return Bodies(str(path), (), lambda _, progress: _valid(path, read, progress))
    bodies = _valid(path, partial(format_.open, path, scale=scale), progress)
    together = bodies.read_together
    return replace(
        bodies,
        read=lambda index, progress: _valid(path, partial(bodies.read, index), progress),
        read_together=together and partial(_valid, path, together),
    )


def _valid(path: Path | str, read: Callable[..., Result], progress: Progress) -> Result:
    """Read; a valid format that holds no valid recording is an invalid file too."""
    try:
        return read(progress=progress)
    except InvalidMotionError as error:
        raise InvalidFileError(f"{path}: {error}") from None


def _unknown_format(path: Path | str) -> InvalidFileError:
    """Return why a file or folder of no known format has no motion."""
    if detect_depth_format(path) is not None:
        return InvalidFileError(
            f"{path} has depth images but no motion yet. Track the actor in it first."
        )
    if Path(path).is_dir():
        return InvalidFileError(
            f"{path} is a folder without depth images. Choose a file in it."
        )
    names = ", ".join(each.name for each in FORMATS if not each.is_refused)
    return InvalidFileError(
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
            head += file.read(min(json_length(head), MAX_JSON_BYTES))
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise unreadable(path, error) from None
    return next((format_ for format_ in FORMATS if format_.fits(head)), None)


def read_motion_or_tracks(
    path: Path | str,
    *,
    scale: float | None = None,
    body: str | None = None,
    progress: Progress = unwatched,
) -> Motion | Tracks:
    """Read a recording as `read_tracked` does; return the joints of a camera as points."""
    recording = read_tracked(path, scale=scale, body=body, progress=progress)
    return recording.tracks if isinstance(recording, JointRecording) else recording
