"""Read the arrays of `.npy` files, which say nothing but their shape."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidFileError
from ..motion import JointRecording, Motion, Sensor, Tracks
from ..progress import Progress, unwatched
from .containers import read_array
from .conventions import check_scale, z_up_from_y_up
from .joint_files import read_freemocap
from .skeleton_files import NAMES_OF_BODY, is_motion_x, read_motion_x

HUMANML3D_RATE_HZ = 20.0
HUMANML3D_FEATURES = 263


def read_npy(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion | JointRecording | Tracks:
    """Read a `.npy` file by the shape of its array.

    (n_frames, 322) is Motion-X: an SMPL-X body. (n_frames, 22, 3) are the joints of HumanML3D:
    those of SMPL, Y up, 20 Hz. Other points are freemocap's (`read_freemocap`).

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
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
        return read_motion_x(array, scale, progress)
    if array.ndim == 3 and array.shape[1:] == (len(NAMES_OF_BODY), 3):
        return _humanml3d_joints(array, 1.0 if scale is None else scale)
    if array.ndim == 2 and array.shape[1] == HUMANML3D_FEATURES:
        raise InvalidFileError(
            f"{path} holds the {HUMANML3D_FEATURES} features of HumanML3D, not a pose. Recover"
            " the 22 joints with its recover_from_ric, and save those."
        )
    return read_freemocap(path, scale=scale, progress=progress)


def _humanml3d_joints(joints: NDArray[np.float64], scale: float) -> JointRecording:
    finite = np.isfinite(joints).all(axis=-1)[..., None]
    positions = z_up_from_y_up(scale * np.where(finite, joints, np.nan))
    return JointRecording(
        Tracks(NAMES_OF_BODY, positions, HUMANML3D_RATE_HZ), None, Sensor.OTHER
    )
