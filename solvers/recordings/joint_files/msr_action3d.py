"""Read the skeletons of MSR Action3D: Kinect v1 joints with confidence, as text."""

from pathlib import Path

import numpy as np

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched, within
from ..containers import read_bytes, read_rows
from ..conventions import JointSamples, check_scale, from_kinect_space, joint_recording

FRAME_RATE_HZ = 15.0
"""Frame rate of the data set, hertz; its files do not state it."""
NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
ORDER = (
    "ShoulderLeft", "ShoulderRight", "ShoulderCenter", "Spine", "HipLeft", "HipRight",
    "HipCenter", "ElbowLeft", "ElbowRight", "WristLeft", "WristRight", "HandLeft", "HandRight",
    "KneeLeft", "KneeRight", "AnkleLeft", "AnkleRight", "FootLeft", "FootRight", "Head",
)  # fmt: skip
WIDTH = 4
MIN_EXTENT_M, MAX_EXTENT_M = 0.3, 5.0
"""Minimum and maximum extent of a body on its longest axis, meters. They guard files of the
data set that hold screen coordinates, in pixels."""


def is_msr_action3d(head: bytes) -> bool:
    """Return whether the first bytes are lines of four numbers, the last from 0 to 1."""
    lines = head.split(b"\n")[: len(ORDER)]
    return len(lines) == len(ORDER) and all(map(_is_joint, lines))


def _is_joint(line: bytes) -> bool:
    try:
        numbers = [float(word) for word in line.split()]
    except ValueError:
        return False
    return len(numbers) == WIDTH and 0.0 <= numbers[-1] <= 1.0


def read_msr_action3d(
    path: Path | str,
    *,
    scale: float | None = None,
    frame_rate: float = FRAME_RATE_HZ,
    progress: Progress = unwatched,
) -> JointRecording:
    """Read MSR Action3D text [1]_ (real-world coordinates), in meters, Z up.

    Each frame is 20 lines, one per joint: x, y, z and a confidence from 0 to 1. The basis of
    the confidence is not published, and joints of confidence 0 have plausible positions.
    Therefore all positions and their confidence are kept, and there is no tracking state. The
    file has no frame rate; the data set was recorded at about 15 Hz.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    frame_rate : float, hertz
    progress : Progress

    Returns
    -------
    JointRecording
        All 20 joints of the Kinect v1 in its own order; the camera looks along +Y.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, truncated within a frame, or has no joints.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Li, Zhang, Liu (2010). Action recognition based on a bag of 3D points. CVPR
       workshops. doi:10.1109/CVPRW.2010.5543273
    """
    check_scale(scale)
    lines = read_bytes(path).splitlines()
    counts = range(1, len(lines) + 1)
    rows = read_rows(lines, WIDTH, path, counts, within(progress, 0.0, 0.9))
    if len(rows) % len(NAMES) or not len(rows):
        raise InvalidFileError(
            f"{path} has {len(rows)} lines of joints, which is not a multiple of {len(NAMES)}."
            " It is cut short; delete the lines of the last frame."
        )
    joint_order = [ORDER.index(name) for name in NAMES]
    joints = rows.reshape(-1, len(NAMES), WIDTH)[:, joint_order]
    extents = np.ptp(np.nan_to_num(joints[..., :3]), axis=1).max(axis=-1)
    extents = extents[extents > 0.0]  # All joints are 0 before the actor is detected.
    if scale is None and len(extents) and not MIN_EXTENT_M < np.median(extents) < MAX_EXTENT_M:
        raise InvalidFileError(
            f"{path} has four numbers in each line like MSR Action3D, but they are not joints"
            " of a body in meters. Export its real-world coordinates, or give the scale."
        )
    return joint_recording(
        path,
        JointSamples(
            NAMES,
            from_kinect_space(joints[..., :3]),
            Sensor.KINECT_V1,
            confidence=np.clip(np.nan_to_num(joints[..., 3]), 0.0, 1.0),
            frame_rate=frame_rate,
        ),
        scale=scale,
        progress=progress,
    )
