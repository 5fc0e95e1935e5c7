"""A table of joints that any recorder can write: see docs/formats/joint_csv.md."""

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
from ..conventions import check_scale
from .joint_header import FORMAT, VERSION, build_recording, check_names, parse_header

TIME = "time"
AXES = ("x", "y", "z")
FIELDS = (*AXES, "state", "confidence")
FRAMES_AT_ONCE = 1000


class _Values(NamedTuple):
    """What stands in the columns."""

    positions: NDArray[np.float64]
    """Shape (n_frames, n_joints, 3), in the file's unit."""
    states: NDArray[np.float64] | None
    confidence: NDArray[np.float64] | None
    times: NDArray[np.float64] | None


def is_joint_csv(head: bytes) -> bool:
    """Tell from the first bytes."""
    return head.lstrip().startswith(FORMAT.encode())


def read_joint_csv(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> JointRecording:
    """Read our own table of joints, in metres, Z up; what was not observed is NaN.

    The first line is `mocap-assist-joints,1,frame_rate=30,units=m,up=z,sensor=other`, where
    only the first two words are needed; the second names the columns `time`, `<joint>.x`, `.y`,
    `.z`, and where known `.state` (2, 1, 0) and `.confidence` (0 to 1). Each further line is a
    frame; what is not observed stays empty. Without a frame rate each frame has its time in
    seconds, and is brought to a constant rate, where gaps stay gaps.

    Parameters
    ----------
    path : Path or str
    scale : float, metres per unit of the file, or None
        None takes the file's word.
    progress : Progress

    Returns
    -------
    JointRecording

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, cut short, or has no joints.
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
            f"{path}: neither a frame_rate in its first line nor a column {TIME} tells when"
            " each frame was seen."
        )
    return build_recording(
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


def write_joint_csv(
    recording: JointRecording, path: Path | str, *, progress: Progress = unwatched
) -> None:
    """Write joints as `read_joint_csv` reads them, whole or not at all, in metres, Z up.

    Every number is written with all its digits. What was not observed is left empty; reading
    gives it the tracking state 0.

    Parameters
    ----------
    recording : JointRecording
    path : Path or str
    progress : Progress

    Raises
    ------
    InvalidMotionError
        A joint's name has letters that do not fit in one line.
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
    """Return the words `key=value` of the first line, and its format and version."""
    words = [word.strip() for word in line.decode("latin-1").split(",")]
    pairs = [word.partition("=") for word in words[2:]]
    said = {key.strip().lower(): value for key, equals, value in pairs if equals}
    return said | {"format": words[0], "version": "".join(words[1:2])}


def _columns(line: bytes, place: str) -> list[str]:
    try:
        (columns,) = csv.reader([line.decode("utf-8")])
    except (ValueError, csv.Error):
        raise InvalidFileError(
            f"{place}: the names of the columns are no text that can be read. Write them in"
            " UTF-8, parted by commas."
        ) from None
    columns = [column.strip() for column in columns]
    if twice := [name for name, times in Counter(columns).items() if times > 1]:
        raise InvalidFileError(
            f"{place}: more than one column is called {shown(twice[0])!r}; names must differ."
        )
    return columns


def _joint_names(columns: Sequence[str]) -> list[str]:
    return [column[:-2] for column in columns if column.endswith(".x")]


def _values(
    reader: LineReader, columns: Sequence[str], path: Path | str, progress: Progress
) -> _Values:
    """Return what the lines below the names of the columns hold."""
    rows = stream_rows(reader, len(columns), path, progress, tidied=spaces_from_commas)
    places = {column: at for at, column in enumerate(columns)}
    names = _joint_names(columns)
    used = {field: _field_columns(places, names, field, path) for field in FIELDS}
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
        times=rows[:, places[TIME]].copy() if TIME in places else None,
    )


def _field_columns(
    places: Mapping[str, int], names: Sequence[str], field: str, path: Path | str
) -> list[int]:
    """Return the columns of one field, one for each joint, or none at all."""
    found = [name for name in names if f"{name}.{field}" in places]
    if found and len(found) < len(names):
        lacking = next(name for name in names if name not in found)
        raise InvalidFileError(
            f"{path}: {shown(lacking)} has no column .{field}, though other joints have one."
        )
    return [places[f"{name}.{field}"] for name in found]
