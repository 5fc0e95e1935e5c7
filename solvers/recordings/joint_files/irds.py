"""Read joint recordings of the IntelliRehabDS: Kinect v2 joints as text."""

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched
from ..containers import printable, read_bytes, read_number, shown
from ..conventions import (
    MILLISECOND,
    Bodies,
    JointSamples,
    bodies_of_frames,
    check_scale,
    from_kinect_space,
    joint_recording,
    recorded_seconds,
    stack_body_frames,
)
from ..identities import follow_bodies

STATES = {b"NotTracked": 0, b"Inferred": 1, b"Tracked": 2}
HEAD = re.compile(
    rb"\s*(?:Version[\d.]+\s+)?\d+\s*,\s*\d+\s*,\s*\d+\s*,\s*\(\s*\w+\s*,\s*(Not|Inf|Track)"
)
NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
JOINT_INDICES = {name.encode(): index for index, name in enumerate(NAMES)}


class Line(NamedTuple):
    """One line of the file: a body at a time."""

    body: str
    time: float
    joints: NDArray[np.float64]
    """x, y, z and state, shape (n_joints, 4)."""


def is_irds(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return HEAD.match(head) is not None


def open_irds(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open IRDS text [1]_, in meters, Z up; joints that were not tracked are NaN.

    One line per frame: number, body, milliseconds, then `(joint,state,x,y,z,u,v)` for each
    joint; the pixel coordinates u, v are not read. Frames are resampled to a constant rate by
    their time stamps; missing frames, and frames without the body, are gaps.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: meters.
    progress : Progress

    Returns
    -------
    Bodies of JointRecording
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
    observed: list[Line] = []
    lines = read_bytes(path).splitlines()
    for count, line in enumerate(lines, start=1):
        if b"(" in line:
            observed.append(_line(line, f"{path}, line {count}"))
        elif count > 1 and line.strip():
            raise InvalidFileError(
                f"{path}, line {count}: there are no joints. The file is damaged or cut short;"
                " delete that line."
            )
        progress(count / len(lines), "Reading")
    if not observed:
        raise InvalidFileError(f"{path} is not an IRDS recording: no line has joints.")
    times, frames = _frames(observed)
    frames = follow_bodies(frames, lambda joints: joints[:, :3], times, progress)
    keys, bodies = bodies_of_frames(frames, recorded_seconds(times))

    def read(index: int, progress: Progress) -> JointRecording:
        joints = stack_body_frames(keys[index], frames)
        return joint_recording(
            path,
            JointSamples(
                NAMES,
                from_kinect_space(joints[..., :3]),
                Sensor.KINECT_V2,
                states=np.nan_to_num(joints[..., 3]).astype(np.int8),
                times=times,
            ),
            scale=scale,
            progress=progress,
        )

    return Bodies(str(path), bodies, read)


def _frames(
    lines: list[Line],
) -> tuple[NDArray[np.float64], list[dict[str, NDArray[np.float64]]]]:
    """Return times in seconds and the joints of each body then; a body twice makes two."""
    times: list[float] = []
    frames: list[dict[str, NDArray[np.float64]]] = []
    for line in lines:
        if not frames or line.time != times[-1] or line.body in frames[-1]:
            times.append(line.time)
            frames.append({})
        frames[-1][line.body] = line.joints
    return MILLISECOND * np.array(times), frames


def _line(line: bytes, location: str) -> Line:
    head, *joints = line.rstrip().split(b"(")
    fields = [word.strip() for word in head.split(b",")]
    if len(fields) != 4 or len(joints) != len(NAMES) or not joints[-1].endswith(b")"):
        raise InvalidFileError(
            f"{location}: number, body, time and {len(NAMES)} joints are required. The file is"
            " damaged or cut short; delete that line."
        )
    values = np.full((len(NAMES), 4), np.nan)
    values[:, 3] = 0.0
    for joint in joints:
        name, *words = (word.strip() for word in joint.split(b")")[0].split(b","))
        if name not in JOINT_INDICES or len(words) < 4 or words[0] not in STATES:
            raise InvalidFileError(
                f"{location}: {shown(joint.decode('ascii', 'backslashreplace'))!r} is not a"
                " joint of a Kinect v2 with state and position. The file is damaged; delete"
                " that line."
            )
        values[JOINT_INDICES[name]] = [
            *(read_number(word, location) for word in words[1:4]),
            STATES[words[0]],
        ]
    body = printable(fields[1].decode("latin-1"))
    return Line(body, read_number(fields[2], location), values)
