"""Read the arrays of NumPy's files, which say little but their shape."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..motion import JointRecording, Motion, Tracks
from ..motion.humanoid import ADULT_STATURE_M
from ..progress import Progress, Remark, unwatched
from .containers import archive_names, read_archive_members, read_array
from .conventions import DEFAULT_FRAME_RATE, check_scale
from .joint_files import (
    body_of_points,
    has_layout,
    points_of_array,
    read_body,
    read_freemocap_points,
)
from .skeleton_files import is_motion_x, read_motion_x

HUMANML3D_FEATURES = 263
POINT_MEMBERS = (
    "positions", "joints", "joint_positions", "joints3d", "joints_3d", "keypoints3d",
    "keypoints_3d", "kps3d", "pose3d", "pose_3d", "poses3d", "poses_3d", "points3d",
    "points_3d", "xyz", "points", "keypoints", "arr_0",
)  # fmt: skip
"""Names of joints in archives, the clear ones first."""


def read_npy(
    path: Path | str,
    *,
    scale: float | None = None,
    height: float = ADULT_STATURE_M,
    on_floor: bool = True,
    progress: Progress = unwatched,
) -> Motion | JointRecording | Tracks:
    """Read a `.npy` file by the shape of its array.

    (n_frames, 322) is Motion-X: an SMPL-X body. Points of (n_frames, n_points, 3) are joints if
    they form a body in one of the known orders (`name_joints`), such as the 22 of HumanML3D, 20
    Hz, or the 17 of Human3.6M. Other points are freemocap's (`read_freemocap`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    height : float, meters
        Stature of an SMPL-X body (`open_smpl`).
    on_floor : bool
        Whether the feet of such a body are put on the floor.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds features, from which no pose follows, or points
        of images.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    array = read_array(path)
    if is_motion_x(array.shape):
        return read_motion_x(array, scale, height, on_floor, progress)
    if array.ndim == 2 and array.shape[1] == HUMANML3D_FEATURES:
        raise InvalidFileError(
            f"{path} holds the {HUMANML3D_FEATURES} features of HumanML3D, not a pose. Recover"
            " the 22 joints with its recover_from_ric, and save those."
        )
    return _read_points(path, points_of_array(path, array), scale, progress)


def is_point_archive(head: bytes) -> bool:
    """Return whether a file is an `.npz` archive with joints, from its beginning and end."""
    names = {name.lower() for name in archive_names(head)}
    return "depth" not in names and not names.isdisjoint(POINT_MEMBERS)


def read_point_archive(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording | Tracks:
    """Read the points of an `.npz` archive as `read_npy` does.

    Raises
    ------
    InvalidFileError
        The file is missing or damaged, or has no points over time.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    members = read_archive_members(path, POINT_MEMBERS)
    found = next((members[name] for name in POINT_MEMBERS if name in members), None)
    if found is None:
        raise InvalidFileError(f"{path} has no array of joints. Export it again.")
    return _read_points(path, points_of_array(path, found), scale, progress)


def _read_points(
    path: Path | str, points: NDArray[np.float64], scale: float | None, progress: Progress
) -> JointRecording | Tracks:
    points = np.where(np.isfinite(points).all(axis=-1)[..., None], points, np.nan)
    body = body_of_points(path, points)
    n_points = points.shape[1]
    if body is not None:
        return read_body(path, body, scale, progress)
    if body is None and has_layout(n_points):
        progress(
            0.9,
            Remark(
                f"The {n_points} points have no names and form no body in a known order; store"
                " the joints as a joint CSV, which has names"
            ),
        )
    return read_freemocap_points(path, points, scale, DEFAULT_FRAME_RATE, progress)
