"""The supported formats, and which of them a file has."""

import re
from os import SEEK_END
from pathlib import Path

from ..errors import InvalidFileError
from ..files import open_regular, unreadable_error
from .containers import (
    BYTE_ORDER_MARK,
    ZIP_MEMBER,
    as_utf8,
    check_folder_access,
    find_separator,
    is_c3d,
    is_matlab,
    is_missing,
    json_length,
    split_cells,
)
from .depth_files import is_depth_mat
from .format_description import Format, one_body
from .joint_files import (
    MAX_TITLE_LINES,
    MIN_POINTS,
    is_azure_csv,
    is_azure_json,
    is_frame_json,
    is_frames_json,
    is_irds,
    is_joint_csv,
    is_joint_json,
    is_json_table,
    is_kinect_csv,
    is_long_table,
    is_mediapipe_csv,
    is_msr_action3d,
    is_npy,
    is_ntu_skeleton,
    is_nuitrack_csv,
    is_nuitrack_json,
    is_point_table,
    is_ui_prmd,
    is_zed_json,
    open_azure_csv,
    open_azure_json,
    open_frames_json,
    open_irds,
    open_joint_csv,
    open_joint_json,
    open_json_table,
    open_long_table,
    open_ntu_skeleton,
    open_nuitrack_csv,
    open_nuitrack_json,
    open_point_table,
    open_zed_json,
    read_kinect_csv,
    read_mediapipe_csv,
    read_msr_action3d,
    read_ui_prmd,
)
from .marker_files import (
    is_motive_csv,
    is_qualisys_tsv,
    is_vicon_csv,
    open_c3d,
    open_motive_csv,
    open_qualisys_tsv,
    open_trc,
    open_vicon_csv,
)
from .matlab_points import open_matlab_points
from .numpy_files import is_frame_npy, open_npy
from .point_archives import is_point_archive, open_point_archive
from .refuse_stand_ins import REFUSALS
from .skeleton_files import (
    is_frame_smpl,
    is_frame_smpl_json,
    is_kimodo,
    is_mvnx,
    is_opensim_json,
    is_smpl,
    is_smpl_json,
    is_vrma,
    open_bvh,
    open_kimodo,
    open_mvnx,
    open_smpl,
    open_smpl_json,
    read_acclaim,
    read_opensim_json,
    read_vrma,
)

HEAD_BYTES = 4096
MAX_TITLES_BYTES = 1 << 17
"""Of the first lines of a table, where these are longer than the head of other files."""
NUMBERS_FIRST = re.compile(rb'\s*\{\s*"[^"]*"\s*:\s*\[[-+.\deE,\s]*\Z')
"""JSON whose first member is longer than the head, such as the times of all frames."""
MAX_DIRECTORY_BYTES = 1 << 16
"""Of the end of an archive, where the names of its members are."""
MAX_JSON_BYTES = 1 << 22
"""Of a glTF file, read to see what it holds."""


def _is_bvh(head: bytes) -> bool:
    """Detect the first words, above which comments may be."""
    first = re.search(rb"(?im)^\s*HIERARCHY\s+ROOT\s", head)
    return first is not None or head.lstrip()[:9].upper() == b"HIERARCHY"


def _is_acclaim(head: bytes) -> bool:
    text = re.sub(rb"(?m)^\s*#.*$", b"", head).lstrip()
    return re.match(rb"(?i):(FULLY-SPECIFIED|DEGREES|RADIANS)|1\s+root\s", text) is not None


def _is_trc(head: bytes) -> bool:
    """Detect TRC; some programs omit the first line, or write it in lower case."""
    return re.match(rb"(?i)[\s\"]*(PathFileType|DataRate\W+CameraRate)\b", head) is not None


def _is_wide_table(head: bytes) -> bool:
    """Return whether a head is text with long or blank lines of cells; JSON has none."""
    is_text = len(head) >= HEAD_BYTES - len(BYTE_ORDER_MARK) and b"\0" not in head
    is_json = head.lstrip()[:1] in {b"{", b"["}
    lines = head.splitlines()
    return is_text and not is_json and (len(lines) <= MAX_TITLE_LINES or _is_blank(lines[-2]))


def _is_blank(line: bytes) -> bool:
    """Return whether most cells of a line are blank, as those of points that come later."""
    cells = split_cells(line, find_separator(line))
    return len(cells) >= MIN_POINTS and sum(map(is_missing, cells)) > len(cells) / 2


FORMATS = (
    Format("BVH", _is_bvh, open_bvh, has_skeleton=True),
    Format("Acclaim AMC", _is_acclaim, one_body(read_acclaim), has_skeleton=True),
    Format("VRM animation", is_vrma, one_body(read_vrma), has_skeleton=True),
    *(Format(each.name, each.fits, one_body(each.read), is_refused=True) for each in REFUSALS),
    Format(
        "SMPL parameters",
        is_smpl,
        open_smpl,
        has_skeleton=True,
        lacks_bones=True,
        is_one_frame=is_frame_smpl,
    ),
    Format(
        "SMPL parameters in JSON",
        is_smpl_json,
        open_smpl_json,
        has_skeleton=True,
        lacks_bones=True,
        is_one_frame=is_frame_smpl_json,
    ),
    Format("Kimodo", is_kimodo, open_kimodo, has_skeleton=True),
    Format("Xsens MVNX", is_mvnx, open_mvnx, has_skeleton=True),
    Format("OpenCap JSON", is_opensim_json, one_body(read_opensim_json), has_skeleton=True),
    Format("C3D", is_c3d, open_c3d, has_markers=True),
    Format("TRC", _is_trc, open_trc, has_markers=True),
    Format("OptiTrack CSV", is_motive_csv, open_motive_csv, has_markers=True),
    Format("Qualisys TSV", is_qualisys_tsv, open_qualisys_tsv, has_markers=True),
    Format("Vicon CSV", is_vicon_csv, open_vicon_csv, has_markers=True),
    Format("IRDS", is_irds, open_irds),
    Format("Kinect v2 CSV", is_kinect_csv, one_body(read_kinect_csv)),
    Format("Azure Kinect CSV", is_azure_csv, open_azure_csv),
    Format("Azure Kinect JSON", is_azure_json, open_azure_json),
    Format("NTU RGB+D", is_ntu_skeleton, open_ntu_skeleton),
    Format("MSR Action3D", is_msr_action3d, one_body(read_msr_action3d)),
    Format("UI-PRMD", is_ui_prmd, one_body(read_ui_prmd)),
    Format("freemocap", is_npy, open_npy, lacks_bones=True, is_one_frame=is_frame_npy),
    Format("joints of NumPy", is_point_archive, open_point_archive),
    Format("joints of MATLAB", is_matlab, open_matlab_points),
    Format("ZED JSON", is_zed_json, open_zed_json),
    Format("Nuitrack CSV", is_nuitrack_csv, open_nuitrack_csv),
    Format("Nuitrack JSON", is_nuitrack_json, open_nuitrack_json),
    Format("MediaPipe CSV", is_mediapipe_csv, one_body(read_mediapipe_csv)),
    Format("joint CSV", is_joint_csv, open_joint_csv),
    Format("joint JSON", is_joint_json, open_joint_json),
    Format("table in JSON", is_json_table, open_json_table),
    Format("JSON of joints", is_frames_json, open_frames_json, is_one_frame=is_frame_json),
    Format("table with a line per joint", is_long_table, open_long_table),
    Format("table of points", is_point_table, open_point_table),
)
"""Supported formats; add a line here for a new one."""


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
            head = as_utf8(file.read(HEAD_BYTES))
            head += file.read(min(json_length(head), MAX_JSON_BYTES))
            if _is_wide_table(head) or NUMBERS_FIRST.match(head):
                head += file.read(MAX_TITLES_BYTES)
            if head.startswith(ZIP_MEMBER):
                file.seek(max(HEAD_BYTES, file.seek(0, SEEK_END) - MAX_DIRECTORY_BYTES))
                head += file.read()
    except FileNotFoundError:
        raise InvalidFileError(f"There is no file {path}.") from None
    except OSError as error:
        raise unreadable_error(path, error) from None
    if is_depth_mat(Path(path), head):
        return None
    return next((format_ for format_ in FORMATS if format_.fits(head)), None)
