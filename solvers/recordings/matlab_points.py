"""Read joints from MATLAB files, whose arrays have any name and order of axes."""

from pathlib import Path

import numpy as np

from ..arrays import Array
from ..errors import InvalidFileError
from ..motion import JointRecording, Tracks
from ..progress import Progress, unwatched
from .containers import MatlabArray, matlab_arrays, shown
from .conventions import Bodies, check_scale, common_rate
from .numpy_files import Stated, open_points, step_along
from .point_archives import RATE_MEMBERS
from .point_bodies import has_layout, is_other_array, rank_of_array

COORDINATES = 3


def open_matlab_points(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording | Tracks]:
    """Open the joints of a MATLAB 5 file as `open_npy` does.

    They are an array with frames, joints and coordinates in any order. Of several arrays, the
    one is read whose name says most clearly that it holds positions (`rank_of_array`). Arrays
    in structures and cells are not read.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing or damaged, or has no such array.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    arrays = matlab_arrays(Path(path))
    found = [array for array in arrays if _may_be_joints(array)]
    if not found:
        names = shown(", ".join(array.name for array in arrays)) or "none of numbers"
        raise InvalidFileError(
            f"{path} is a MATLAB file without an array of joints over time ({names}). Save the"
            " joints in it as an array of the shape (frames, joints, 3) called joints."
        )
    joints = min(found, key=lambda array: rank_of_array(array.name))
    progress(0.5, "Reading")
    stated = Stated(_rate(arrays), None, ())
    return open_points(path, _over_time(_numbers(joints)), scale, stated, progress)


def _may_be_joints(array: MatlabArray) -> bool:
    """Return whether an array may hold the coordinates of joints over time."""
    if is_other_array(array.name) or min(array.shape, default=0) < 2:
        return False
    if len(array.shape) == 2:
        return array.shape[1] % COORDINATES == 0 and has_layout(array.shape[1] // COORDINATES)
    return len(array.shape) == 3 and COORDINATES in array.shape


def _numbers(array: MatlabArray) -> Array:
    content = np.frombuffer(array.content.read(0, array.content.size), array.kind)
    return content.astype(np.float64).reshape(array.shape, order="F")


def _over_time(array: Array) -> Array:
    """Return an array of three axes with the frames first and the coordinates last.

    Joints move little from frame to frame, so the frames are on the axis with small steps.
    """
    if array.ndim != 3:
        return array
    axis = max(range(3), key=lambda each: (array.shape[each] == COORDINATES, each))
    points = np.moveaxis(array, axis, 2)
    return points if step_along(points, 0) <= step_along(points, 1) else points.swapaxes(0, 1)


def _rate(arrays: list[MatlabArray]) -> float | None:
    """Return the frames per second that a file states; None if it states none."""
    rates = {array.name.lower(): array for array in arrays if set(array.shape) == {1}}
    name = next((each for each in RATE_MEMBERS if each in rates), None)
    rate = 0.0 if name is None else float(_numbers(rates[name]).item())
    return common_rate(rate) if 0.0 < rate < np.inf else None
