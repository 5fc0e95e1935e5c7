"""Read the joints of NumPy archives, with what these state next to them."""

from pathlib import Path

import numpy as np

from ..arrays import Array
from ..errors import InvalidFileError
from ..motion import JointRecording, Tracks
from ..progress import Progress, unwatched
from .containers import archive_names, read_archive_members, read_archive_words
from .conventions import Bodies, check_scale, common_rate, path_from_camera
from .numpy_files import Stated, open_points
from .point_bodies import NAMES_OF_ROOT, POINT_MEMBERS, name_of_root, transforms_at

RATE_MEMBERS = ("fps", "frame_rate", "framerate", "mocap_frame_rate", "mocap_framerate")
"""Names of frames per second in archives."""
NAME_MEMBERS = (
    "joint_names", "joints_names", "keypoint_names", "keypoints_names", "marker_names",
    "landmark_names", "bone_names", "names", "labels",
)  # fmt: skip
"""Names of the names of joints in archives."""


def is_point_archive(head: bytes) -> bool:
    """Return whether a file is an `.npz` archive with joints, from its beginning and end."""
    names = {name.lower() for name in archive_names(head)}
    return "depth" not in names and not names.isdisjoint(POINT_MEMBERS)


def open_point_archive(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording | Tracks]:
    """Open the points of an `.npz` archive as `open_npy` does.

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
    members = read_archive_members(path, POINT_MEMBERS, str.lower)
    found = next((members[name] for name in POINT_MEMBERS if name in members), None)
    if found is None:
        raise InvalidFileError(f"{path} has no array of joints. Export it again.")
    stated = Stated(_stated_rate(path), _root_path(path, progress), _stated_names(path))
    return open_points(path, found, scale, stated, progress)


def _stated_names(path: Path | str) -> tuple[str, ...]:
    """Return the names of the joints that an archive states; empty without any."""
    try:
        return read_archive_words(path, NAME_MEMBERS)
    except InvalidFileError:  # pickled words
        return ()


def _root_path(path: Path | str, progress: Progress) -> Array | None:
    """Return the transforms of one body that an archive states, (n_frames, 4, 4)."""
    members = read_archive_members(path, NAMES_OF_ROOT, name_of_root)
    name = next((each for each in NAMES_OF_ROOT if each in members), "")
    found = members.get(name, np.empty(0))
    if not found.size or found.shape[-1] != 3 or found.size != 3 * max(found.shape[:2]):
        return None
    positions, limited = path_from_camera(name, found.reshape(-1, 3))
    if limited:
        progress(0.1, limited)
    return transforms_at(positions)


def _stated_rate(path: Path | str) -> float | None:
    """Return the frames per second that an archive states; None if it states none."""
    try:
        members = read_archive_members(path, RATE_MEMBERS, str.lower)
    except InvalidFileError:  # words or None in place of a number
        return None
    stated = (members[name] for name in RATE_MEMBERS if name in members)
    rate = next((float(each.item()) for each in stated if each.size == 1), 0.0)
    return common_rate(rate) if 0.0 < rate < np.inf else None
