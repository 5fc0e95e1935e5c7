"""Read tables of Azure Kinect joints: a line per joint, or a line per frame."""

import re
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...motion import SENSOR_JOINTS, JointRecording, Sensor
from ...progress import Progress, unwatched
from ..containers import (
    GrowingTable,
    LineReader,
    printable,
    read_number,
    spaces_from_commas,
    stream_rows,
)
from ..conventions import (
    DEFAULT_FRAME_RATE,
    MILLIMETER,
    Bodies,
    Body,
    JointSamples,
    bodies_of_frames,
    check_scale,
    from_azure_space,
    joint_recording,
    observed_body,
)
from ..identities import follow_bodies

NAMES = SENSOR_JOINTS[Sensor.AZURE_KINECT]
PER_JOINT = re.compile(rb"(?i)[^\n]*\n?[ \t]*body id\s*,\s*joint #\s*,\s*x\s*,\s*y\s*,\s*z")
PER_FRAME = re.compile(rb"(?i)[^\n]*\bpelvis\.x\s*,")
ONLY_AZURE = re.compile(rb"(?i)[^\n]*(\bspine_?(chest|nav[ae]l)\b|\bclavicle)")
MIN_WORDS = 10
NOT_OBSERVED = np.tile((np.nan, np.nan, np.nan, 0.0), (len(NAMES), 1))
SPELLINGS = {name.upper(): name for name in NAMES} | {"SPINENAVAL": "SpineNavel"}
STATES = (  # Confidence levels of the SDK, and the corresponding tracking states.
    (rb"out of range|\bnone\b|^0$", 0),
    (rb"not observed|\blow\b|^1$", 1),
    (rb"\bmedium\b|\bhigh\b|^[23]$", 2),
)


def is_azure_csv(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    per_frame = PER_FRAME.match(head) and ONLY_AZURE.match(head)
    return bool(PER_JOINT.match(head) or per_frame)


def azure_joint(name: str) -> str:
    """Return the name of a joint in our spelling; names unknown to the SDK are unchanged."""
    return SPELLINGS.get(name.strip().replace("_", "").upper(), name.strip())


def open_azure_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open a table of Azure Kinect joints, in meters, Z up; joints not tracked are NaN.

    Two layouts are supported. A line per joint has the header `Body ID, Joint #, x, y, z, x, y,
    z, w, Confidence Level`: a new frame of a body begins when its joint numbers restart, and
    a new frame of the recording when a body comes again. A line per frame has the header
    `PELVIS.x, PELVIS.y, ...`. Neither has times; 30 frames per second are assumed.
    Orientations are not read. Medium and high confidence are state 2, low (predicted) is 1,
    none is 0.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: millimeters.
    progress : Progress

    Returns
    -------
    Bodies of JointRecording
        All 32 joints in the SDK's order, or those of the columns; the camera looks along +Y.
        No tracking state from a line per frame.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged or has no joints.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    headings = [line for line in reader.peek(4) if line.strip()]  # "\r\r\n" leaves blank ones
    names = NAMES
    if PER_JOINT.match(b"\n".join(headings[:2])):
        listed, values_of = _read_joint_lines(reader, path, progress)
    else:
        names, values = _read_frame_lines(reader, path, progress)
        n_frames = len(values)
        only = observed_body("1", np.arange(n_frames), n_frames, n_frames / DEFAULT_FRAME_RATE)
        listed, values_of = (only,), lambda index: values

    def read(index: int, progress: Progress) -> JointRecording:
        values = values_of(index)
        states = values[..., 3].astype(np.int8) if values.shape[-1] > 3 else None
        return joint_recording(
            path,
            JointSamples(
                names, from_azure_space(values[..., :3]), Sensor.AZURE_KINECT, states=states
            ),
            scale=scale,
            default_unit=MILLIMETER,
            progress=progress,
        )

    return Bodies(str(path), listed, read)


def _read_joint_lines(
    reader: LineReader, path: Path | str, progress: Progress
) -> tuple[tuple[Body, ...], Callable[[int], NDArray[np.float64]]]:
    """Return the bodies, and x y z state of one, shape (n_frames, n_joints, 4)."""
    bodies: dict[bytes, _BodyTable] = {}
    frame, bodies_in_frame = 0, set[bytes]()
    for block in reader.rest():
        for count, line in enumerate(block.lines, start=block.first):
            words = line.split(b",")
            key = words[0].strip()
            if not key[:1].isdigit():
                continue  # header or blank line
            joint, values = _joint(words, f"{path}, line {count}")
            body = bodies.setdefault(key, _BodyTable())
            if body.begins_frame(joint):
                if key in bodies_in_frame:
                    frame += 1
                    bodies_in_frame.clear()
                bodies_in_frame.add(key)
            body.add_joint(joint, values, frame)
        progress(block.stop, "Reading")
    if not bodies:
        raise InvalidFileError(f"{path} has a header but no joints.")
    return _listed_bodies(bodies, frame + 1, progress)


def _listed_bodies(
    bodies: Mapping[bytes, "_BodyTable"], n_frames: int, progress: Progress
) -> tuple[tuple[Body, ...], Callable[[int], NDArray[np.float64]]]:
    """Return people, swapped back where they were swapped, and a function with their joints."""
    separate: list[dict[bytes, NDArray[np.float64]]] = [{} for _ in range(n_frames)]
    for key, body in bodies.items():
        body.end_frame()
        for at, joints in zip(body.frames, body.joints(), strict=True):
            separate[at][key] = joints
    frames = follow_bodies(separate, lambda joints: joints[:, :3], None, progress)
    keys, listed = bodies_of_frames(
        frames,
        n_frames / DEFAULT_FRAME_RATE,
        lambda number, key: printable(key.decode("latin-1")),
    )
    return listed, lambda index: np.stack([
        found.get(keys[index], NOT_OBSERVED) for found in frames
    ])


class _BodyTable:
    """The observations of one body by frame."""

    def __init__(self) -> None:
        self._table = GrowingTable(4 * len(NAMES))
        self._frame = NOT_OBSERVED.copy()
        self._last = len(NAMES)
        self.frames: list[int] = []
        """Frames of the recording in which it is observed."""

    def begins_frame(self, joint: int) -> bool:
        """Return whether a new frame begins with this joint: the joint numbers restart."""
        return joint <= self._last

    def add_joint(self, joint: int, values: list[float], frame: int) -> None:
        """Add x, y, z and state of a joint in a frame of the recording."""
        if self.begins_frame(joint):
            self.end_frame()
            self.frames.append(frame)
        self._frame[joint] = values
        self._last = joint

    def joints(self) -> NDArray[np.float64]:
        """Return the joints in these frames, shape (n_frames, n_joints, 4)."""
        return self._table.rows().reshape(-1, len(NAMES), 4)

    def end_frame(self) -> None:
        """Keep the joints of the present frame."""
        if self.frames:
            self._table.add(self._frame.reshape(1, -1))
            self._frame[:] = NOT_OBSERVED


def _joint(words: list[bytes], location: str) -> tuple[int, list[float]]:
    """Return the joint's number, and x, y, z and state."""
    joint = words[1].strip() if len(words) >= MIN_WORDS else b""
    if not joint.isdigit() or len(joint) > 2 or int(joint) >= len(NAMES):
        raise InvalidFileError(
            f"{location}: a body, one of {len(NAMES)} joints, its position, rotation and"
            " confidence are required. The file is damaged or cut short; delete that line."
        )
    level = b",".join(words[9:]).strip(b", \t").lower()
    states = [state for pattern, state in STATES if re.search(pattern, level)]
    if not states:
        raise InvalidFileError(
            f"{location}: it does not end with a confidence level. The file is damaged or cut"
            " short; delete that line."
        )
    return int(joint), [
        *(read_number(word.strip(), location) for word in words[2:5]),
        states[0],
    ]


def _read_frame_lines(
    reader: LineReader, path: Path | str, progress: Progress
) -> tuple[tuple[str, ...], NDArray[np.float64]]:
    """Return the joints' names, and x y z, shape (n_frames, n_joints, 3)."""
    heading = b"".join(reader.take()).decode("latin-1")
    header = [word.strip() for word in heading.split(",")]
    columns = {azure_joint(word[:-2]) + word[-2:].lower(): at for at, word in enumerate(header)}
    names = [name for name in NAMES if all(f"{name}.{axis}" in columns for axis in "xyz")]
    if not names:
        raise InvalidFileError(f"{path} has no columns x, y and z of any joint.")
    rows = stream_rows(reader, len(header), path, progress, normalize=spaces_from_commas)
    if not len(rows):
        raise InvalidFileError(f"{path} has a header but no joints.")
    used = [columns[f"{name}.{axis}"] for name in names for axis in "xyz"]
    return tuple(names), rows[:, used].reshape(len(rows), len(names), 3)
