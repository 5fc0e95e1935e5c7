"""Read tables of Kinect v2 joints: one line per frame, x, y, z and state of 25 joints."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched, within
from ..containers import LineReader, spaces_from_commas, stream_rows
from ..conventions import (
    DEFAULT_FRAME_RATE,
    JointSamples,
    check_scale,
    from_kinect_space,
    joint_recording,
)

NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
WITHOUT_TIME = 4 * len(NAMES)
TICK = 1e-7
"""Seconds per tick of the sensor's clock."""


def is_kinect_csv(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    lines = head.split(b"\n")
    first = next((line for line in lines if line.strip()), b"")
    words = first.strip().removesuffix(b",").split(b",")
    if len(words) not in {WITHOUT_TIME, WITHOUT_TIME + 1}:
        return False
    states = words[len(words) - WITHOUT_TIME :][3::4]
    return {state.strip() for state in states} <= {b"0", b"1", b"2"}


def read_kinect_csv(
    path: Path | str,
    *,
    scale: float | None = None,
    frame_rate: float = DEFAULT_FRAME_RATE,
    progress: Progress = unwatched,
) -> JointRecording:
    """Read a table of Kinect v2 joints, in meters, Z up; joints not tracked are NaN.

    Each line has x, y, z and tracking state of the 25 joints in the sensor's order, separated
    by commas. The time in ticks of 100 ns may precede them, as in the LabanotationSuite [1]_;
    without it, as in KIMORE [2]_, `frame_rate` is used. Frames with times are resampled to a
    constant rate; missing frames are gaps. Blank lines are ignored.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    frame_rate : float, hertz
        For a file without times.
    progress : Progress

    Returns
    -------
    JointRecording
        The camera looks along +Y.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged or has no joints.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Ikeuchi, Ma, Yan, Kudoh, Nakamura (2018). Describing upper-body motions based on
       Labanotation for learning-from-observation robots. IJCV 126.
       doi:10.1007/s11263-018-1123-1
    .. [2] Capecci et al. (2019). The KIMORE dataset. IEEE TNSRE 27(7).
       doi:10.1109/TNSRE.2019.2923060
    """
    check_scale(scale)
    reader = LineReader(path)
    reader.skip_blank_lines()
    width = len(b"".join(map(_split_line, reader.peek())).split())
    if width not in {WITHOUT_TIME, WITHOUT_TIME + 1}:
        raise InvalidFileError(
            f"{path} is not a table of Kinect v2 joints: {WITHOUT_TIME} numbers are required in"
            f" each line, or {WITHOUT_TIME + 1} with the time, not {width}."
        )
    rows = stream_rows(reader, width, path, within(progress, 0.0, 0.9), normalize=_split_line)
    joints = rows[:, width - WITHOUT_TIME :].reshape(len(rows), len(NAMES), 4)
    return joint_recording(
        path,
        JointSamples(
            NAMES,
            from_kinect_space(joints[..., :3]),
            Sensor.KINECT_V2,
            states=checked_states(joints[..., 3], path),
            times=rows[:, 0] * TICK if width > WITHOUT_TIME else None,
            frame_rate=frame_rate,
        ),
        scale=scale,
        progress=progress,
    )


def _split_line(line: bytes) -> bytes:
    return spaces_from_commas(line.strip().removesuffix(b","))


def checked_states(values: NDArray[np.float64], path: Path | str) -> NDArray[np.int8]:
    """Convert tracking states, (F, n), to integers; raise InvalidFileError for others."""
    if not np.isin(values, (0.0, 1.0, 2.0)).all():
        raise InvalidFileError(
            f"{path} has tracking states other than 0, 1 and 2: it is damaged, or its columns"
            " are not x, y, z and state."
        )
    return values.astype(np.int8)
