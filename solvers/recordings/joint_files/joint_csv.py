"""Read and write our own CSV of joints: see docs/formats/joints/joint_csv.md."""

import csv
from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import write_atomically
from ...motion import JointRecording
from ...progress import Progress, unwatched, within
from ..containers import LineReader, shown, spaces_from_commas, stream_rows
from ..conventions import Bodies, bodies_of_joints, check_scale
from .joint_header import FORMAT, VERSION, build_recording, check_names, parse_header

TIME = "time"
AXES = ("x", "y", "z")
FIELDS = (*AXES, "state", "confidence")
FRAMES_AT_ONCE = 1000


class _Values(NamedTuple):
    """Contents of the columns."""

    positions: NDArray[np.float64]
    """Shape (n_frames, n_joints, 3), in the file's unit."""
    states: NDArray[np.float64] | None
    confidence: NDArray[np.float64] | None
    times: NDArray[np.float64] | None


def is_joint_csv(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return head.lstrip().startswith(FORMAT.encode())


def open_joint_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open our own table of joints, in meters, Z up; missing values are NaN.

    The first line is `mocap-assist-joints,1,frame_rate=30,units=m,up=z,sensor=other`; only the
    first two words are required. The second line names the columns `time`, `<joint>.x`, `.y`,
    `.z`, and optionally `.state` (2, 1, 0) and `.confidence` (0 to 1). Each further line is a
    frame; missing values are empty. Without a frame rate each frame has its time in seconds,
    and is resampled to a constant rate; gaps stay gaps. Joints of several bodies are called
    `<body>:<joint>`.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: the unit of the file.
    progress : Progress

    Returns
    -------
    Bodies of JointRecording

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, truncated, or has no joints.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    reader = LineReader(path)
    head = reader.take(2)
    if len(head) < 2:
        raise InvalidFileError(f"{path} is cut short: it has no line that names its columns.")
    header = parse_header(_parse_header_line(head[0]), f"{path}, line 1")
    columns = _columns(head[1], f"{path}, line 2")
    values = _values(reader, columns, path, within(progress, 0.0, 0.9))
    if header.frame_rate is None and values.times is None:
        raise InvalidFileError(
            f"{path} has no times: its first line has no frame_rate, and there is no column"
            f" {TIME}. Add one of them."
        )
    recording = build_recording(
        path,
        _joint_names(columns),
        header,
        values.positions,
        states=values.states,
        confidence=values.confidence,
        times=values.times,
        scale=scale,
        progress=progress,
    )
    return bodies_of_joints(path, recording, progress)


def write_joint_csv(
    recording: JointRecording, path: Path | str, *, progress: Progress = unwatched
) -> None:
    """Write joints as `open_joint_csv` reads them, atomically, in meters, Z up.

    Numbers are written with all digits. Missing values are empty; on reading they get the
    tracking state 0.

    Parameters
    ----------
    recording : JointRecording
    path : Path or str
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The name of a joint has letters that cannot be written in one line.
    InvalidFileError
        The file cannot be written.
    SolveCancelled
        Raised by `progress`.
    """
    tracks = recording.tracks
    check_names(tracks.names)
    values = [
        *np.moveaxis(tracks.positions, -1, 0),
        recording.tracking_state,
        tracks.confidence,
    ]
    given = [
        (field, value) for field, value in zip(FIELDS, values, strict=True) if value is not None
    ]
    with write_atomically(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        file.write(
            f"{FORMAT},{VERSION},frame_rate={tracks.frame_rate!r},units=m,up=z,"
            f"sensor={recording.sensor.value}\n"
        )
        csv.writer(file, lineterminator="\n").writerow(
            f"{name}.{field}" for name in tracks.names for field, _ in given
        )
        for start in range(0, tracks.n_frames, FRAMES_AT_ONCE):
            block = [value[start : start + FRAMES_AT_ONCE].tolist() for _, value in given]
            for frame in zip(*block, strict=True):
                file.write(",".join(map(_text, chain(*zip(*frame, strict=True)))) + "\n")
            progress(min(1.0, (start + FRAMES_AT_ONCE) / tracks.n_frames), "Writing")


def _text(value: float) -> str:
    return "" if value != value else repr(value)


def _parse_header_line(line: bytes) -> dict[str, str]:
    """Return the pairs `key=value` of the first line, and its format and version."""
    words = [word.strip() for word in line.decode("latin-1").split(",")]
    pairs = [word.partition("=") for word in words[2:]]
    fields = {key.strip().lower(): value for key, equals, value in pairs if equals}
    return fields | {"format": words[0], "version": "".join(words[1:2])}


def _columns(line: bytes, location: str) -> list[str]:
    try:
        (columns,) = csv.reader([line.decode("utf-8")])
    except (ValueError, csv.Error):
        raise InvalidFileError(
            f"{location}: the names of the columns are not readable text. Write them in UTF-8,"
            " separated by commas."
        ) from None
    columns = [column.strip() for column in columns]
    if duplicates := [name for name, times in Counter(columns).items() if times > 1]:
        raise InvalidFileError(
            f"{location}: more than one column is called {shown(duplicates[0])!r}; names must"
            " differ."
        )
    return columns


def _joint_names(columns: Sequence[str]) -> list[str]:
    return [column[:-2] for column in columns if column.endswith(".x")]


def _values(
    reader: LineReader, columns: Sequence[str], path: Path | str, progress: Progress
) -> _Values:
    """Return the contents of the lines below the column names."""
    rows = stream_rows(reader, len(columns), path, progress, normalize=spaces_from_commas)
    column_indices = {column: at for at, column in enumerate(columns)}
    names = _joint_names(columns)
    used = {field: _field_columns(column_indices, names, field, path) for field in FIELDS}
    axes = [used[axis] for axis in AXES if used[axis]]
    if len(axes) < len(AXES) or not len(rows):
        raise InvalidFileError(
            f"{path} has no frames, or no joints with columns .x, .y and .z."
        )
    positions = rows[:, np.transpose(axes).ravel()]
    return _Values(
        positions=positions.reshape(len(rows), len(names), len(AXES)),
        states=rows[:, used["state"]] if used["state"] else None,
        confidence=rows[:, used["confidence"]] if used["confidence"] else None,
        times=rows[:, column_indices[TIME]].copy() if TIME in column_indices else None,
    )


def _field_columns(
    column_indices: Mapping[str, int], names: Sequence[str], field: str, path: Path | str
) -> list[int]:
    """Return the columns of one field, one for each joint, or an empty list."""
    found = [name for name in names if f"{name}.{field}" in column_indices]
    if found and len(found) < len(names):
        lacking = next(name for name in names if name not in found)
        raise InvalidFileError(
            f"{path}: {shown(lacking)} has no column .{field}, though other joints have one."
        )
    return [column_indices[f"{name}.{field}"] for name in found]
