"""Read the arrays of `.npy` files, which say nothing but their shape."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..motion import AxisName, JointRecording, Motion, Sensor, Tracks, roles_by_name
from ..motion.humanoid import ADULT_STATURE_M
from ..progress import Progress, Remark, unwatched
from .containers import read_array
from .conventions import (
    check_scale,
    conventions_of,
    describe_guessed_axis,
    file_conventions,
    judge_up_of_joints,
    reinterpreted,
    with_conventions,
    z_up_from_y_up,
)
from .joint_files import read_freemocap
from .skeleton_files import NAMES_OF_BODY, is_motion_x, read_motion_x

HUMANML3D_RATE_HZ = 20.0
HUMANML3D_FEATURES = 263


HUMANML3D_UP: dict[AxisName, float] = {"Y": 0.8, "Z": 0.0, "-Y": 0.0}
"""Evidence of the format for each axis: the joints of the data set have Y up."""


def read_npy(
    path: Path | str,
    *,
    scale: float | None = None,
    height: float = ADULT_STATURE_M,
    on_floor: bool = True,
    progress: Progress = unwatched,
) -> Motion | JointRecording | Tracks:
    """Read a `.npy` file by the shape of its array.

    (n_frames, 322) is Motion-X: an SMPL-X body. (n_frames, 22, 3) are the joints of HumanML3D:
    those of SMPL, 20 Hz, Y up unless the body shows another axis. Other points are freemocap's
    (`read_freemocap`).

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
        The file is missing, damaged, or holds features, from which no pose follows.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    array = read_array(path)
    if is_motion_x(array.shape):
        return read_motion_x(array, scale, height, on_floor, progress)
    if array.ndim == 3 and array.shape[1:] == (len(NAMES_OF_BODY), 3):
        return _humanml3d_joints(array, 1.0 if scale is None else scale, progress)
    if array.ndim == 2 and array.shape[1] == HUMANML3D_FEATURES:
        raise InvalidFileError(
            f"{path} holds the {HUMANML3D_FEATURES} features of HumanML3D, not a pose. Recover"
            " the 22 joints with its recover_from_ric, and save those."
        )
    return read_freemocap(path, scale=scale, progress=progress)


def _humanml3d_joints(
    joints: NDArray[np.float64], scale: float, progress: Progress
) -> JointRecording:
    finite = np.isfinite(joints).all(axis=-1)[..., None]
    positions = z_up_from_y_up(scale * np.where(finite, joints, np.nan))
    roles = {
        role: NAMES_OF_BODY.index(name) for role, name in roles_by_name(NAMES_OF_BODY).items()
    }
    judged = judge_up_of_joints(positions, roles, HUMANML3D_UP)
    if not judged.is_clear:
        progress(1.0, Remark(describe_guessed_axis(judged.axis)))
    as_read = file_conventions("Y", unit=scale)
    noted = replace(as_read, has_floor=False)
    tracks = Tracks(NAMES_OF_BODY, positions, HUMANML3D_RATE_HZ, conventions=noted)
    found = reinterpreted(JointRecording(tracks, None, Sensor.OTHER), judged.axis, None)
    return with_conventions(found, replace(conventions_of(found), confidence=judged.confidence))
