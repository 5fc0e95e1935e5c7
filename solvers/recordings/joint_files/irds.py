"""Read joint recordings of the IntelliRehabDS: Kinect v2 joints as text."""

import re
from collections import Counter
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched
from ..containers import read_bytes, read_number, shown
from ..conventions import check_scale, from_kinect_space, joint_recording

STATES = {b"NotTracked": 0, b"Inferred": 1, b"Tracked": 2}
HEAD = re.compile(
    rb"\s*(?:Version[\d.]+\s+)?\d+\s*,\s*\d+\s*,\s*\d+\s*,\s*\(\s*\w+\s*,\s*(Not|Inf|Track)"
)
MILLISECOND = 0.001
NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
JOINT_INDICES = {name.encode(): index for index, name in enumerate(NAMES)}


class Frame(NamedTuple):
    """One line of the file."""

    body: bytes
    time: float
    positions: NDArray[np.float64]
    states: NDArray[np.int8]


def is_irds(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return HEAD.match(head) is not None


def read_irds(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read IRDS text [1]_, in meters, Z up; joints that were not tracked are NaN.

    One line per frame: number, body, milliseconds, then `(joint,state,x,y,z,u,v)` for each
    joint; the pixel coordinates u, v are not read. Frames are resampled to a constant rate by
    their time stamps; missing frames are gaps. Of several bodies the one in most frames is
    used.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    progress : Progress

    Returns
    -------
    JointRecording
        All 25 joints of the Kinect v2 in its own order; the camera looks along +Y.

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
    .. [1] Miron, Sadawi, Ismail, Hussain, Grosan (2021). IntelliRehabDS (IRDS): a dataset of
       physical rehabilitation movements. Data 6(5). doi:10.3390/data6050046
    """
    check_scale(scale)
    frames = []
    lines = read_bytes(path).splitlines()
    for count, line in enumerate(lines, start=1):
        if b"(" in line:
            frames.append(_frame(line, f"{path}, line {count}"))
        elif count > 1 and line.strip():
            raise InvalidFileError(
                f"{path}, line {count}: there are no joints. The file is damaged or cut short;"
                " delete that line."
            )
        progress(0.9 * count / len(lines), "Reading")
    if not frames:
        raise InvalidFileError(f"{path} is not an IRDS recording: no line has joints.")
    ((longest, _),) = Counter(frame.body for frame in frames).most_common(1)
    frames = [frame for frame in frames if frame.body == longest]
    positions = np.stack([frame.positions for frame in frames])
    return joint_recording(
        path,
        NAMES,
        from_kinect_space(positions),
        Sensor.KINECT_V2,
        states=np.stack([frame.states for frame in frames]),
        times=MILLISECOND * np.array([frame.time for frame in frames]),
        scale=scale,
        progress=progress,
    )


def _frame(line: bytes, location: str) -> Frame:
    head, *joints = line.rstrip().split(b"(")
    fields = [word.strip() for word in head.split(b",")]
    if len(fields) != 4 or len(joints) != len(NAMES) or not joints[-1].endswith(b")"):
        raise InvalidFileError(
            f"{location}: number, body, time and {len(NAMES)} joints are required. The file is"
            " damaged or cut short; delete that line."
        )
    positions = np.full((len(NAMES), 3), np.nan)
    states = np.zeros(len(NAMES), dtype=np.int8)
    for joint in joints:
        name, *words = (word.strip() for word in joint.split(b")")[0].split(b","))
        if name not in JOINT_INDICES or len(words) < 4 or words[0] not in STATES:
            raise InvalidFileError(
                f"{location}: {shown(joint.decode('ascii', 'backslashreplace'))!r} is not a"
                " joint of a Kinect v2 with state and position. The file is damaged; delete"
                " that line."
            )
        states[JOINT_INDICES[name]] = STATES[words[0]]
        positions[JOINT_INDICES[name]] = [read_number(word, location) for word in words[1:4]]
    return Frame(fields[1], read_number(fields[2], location), positions, states)
