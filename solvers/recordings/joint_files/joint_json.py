"""Read and write our own JSON of joints: see docs/formats/joints/joint_json.md."""

import json
import re
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidFileError
from ...files import write_atomically
from ...motion import JointRecording
from ...progress import Progress, unwatched
from ..containers import array_from_json, json_members, shown
from ..conventions import Bodies, bodies_of_joints, check_scale
from .joint_header import FORMAT, VERSION, build_recording, check_names, parse_header

HEAD = re.compile(rb'\s*\{[^{}\[\]]*"format"\s*:\s*"' + FORMAT.encode() + rb'"')
NOT_OBSERVED = (np.nan, np.nan, np.nan)


class JointValues(NamedTuple):
    """Positions, shape (n_joints, 3), states and confidence, shape (n_joints,), and seconds."""

    positions: NDArray[np.float64]
    states: NDArray[np.float64] | None
    confidence: NDArray[np.float64] | None
    time: float


def is_joint_json(head: bytes) -> bool:
    """Return whether a file has this format, from its first bytes."""
    return HEAD.match(head) is not None


def open_joint_json(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[JointRecording]:
    """Open our own JSON of joints, in meters, Z up; missing values are NaN.

    One object: `format` "mocap-assist-joints", `version` 1, `frame_rate`, `units` ("m"), `up`
    ("z"), `sensor` ("other"), `joints` (names), `frames`; each frame an object with
    `positions`, one [x, y, z] or null per joint, and optionally `states` (2, 1, 0),
    `confidence` (0 to 1) and `time` (seconds). Without a frame rate, frames are resampled to a
    constant rate by their times; gaps stay gaps. Joints of several bodies are called
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
    fields: dict[str, Any] = {}
    names: list[str] = []
    frames: list[JointValues] = []
    for member in json_members(path):
        if member.key == "frames":
            frames.append(_frame(member.value, f"{path}, frame {len(frames) + 1}"))
            progress(0.9 * member.done, "Reading")
        elif member.key == "joints":
            names.append(str(member.value))
        else:
            fields[member.key] = member.value
    header = parse_header(fields, str(path))
    _check(names, frames, path)
    times = np.array([frame.time for frame in frames])
    if header.frame_rate is None and np.isnan(times).all():
        raise InvalidFileError(
            f"{path} has no times: it has no frame_rate, and its frames have no time. Add one"
            " of them."
        )
    positions = np.stack([frame.positions for frame in frames])
    recording = build_recording(
        path,
        names,
        header,
        positions,
        states=_stacked([frame.states for frame in frames]),
        confidence=_stacked([frame.confidence for frame in frames]),
        times=times,
        scale=scale,
        progress=progress,
    )
    return bodies_of_joints(path, recording, progress)


def write_joint_json(
    recording: JointRecording, path: Path | str, *, progress: Progress = unwatched
) -> None:
    """Write joints as `open_joint_json` reads them, atomically, a line per frame.

    Positions are in meters, Z up, with all digits. Missing positions are null; on reading they
    get the tracking state 0.

    Parameters
    ----------
    recording : JointRecording
    path : Path or str
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The name of a joint has letters that cannot be written.
    InvalidFileError
        The file cannot be written.
    SolveCancelled
        Raised by `progress`.
    """
    tracks = recording.tracks
    check_names(tracks.names)
    fields = {
        "format": FORMAT, "version": VERSION, "frame_rate": tracks.frame_rate, "units": "m",
        "up": "z", "sensor": recording.sensor.value, "joints": tracks.names,
    }  # fmt: skip
    with write_atomically(path) as part, part.open("w", encoding="utf-8") as file:
        file.write(json.dumps(fields)[:-1] + ', "frames": [')
        for frame, observed in enumerate(tracks.visible):
            positions = tracks.positions[frame].tolist()
            line: dict[str, Any] = {
                "positions": [
                    position if is_observed else None
                    for position, is_observed in zip(positions, observed, strict=True)
                ]
            }
            if recording.tracking_state is not None:
                line["states"] = recording.tracking_state[frame].tolist()
            if tracks.confidence is not None:
                line["confidence"] = tracks.confidence[frame].tolist()
            file.write(("," if frame else "") + "\n" + json.dumps(line))
            progress((frame + 1) / tracks.n_frames, "Writing")
        file.write("\n]}\n")


def _frame(frame: Any, location: str) -> JointValues:
    listed = frame.get("positions") if isinstance(frame, dict) else None
    if not isinstance(listed, list):
        raise InvalidFileError(
            f"{location}: a list of positions is required. Export the file again."
        )
    filled = [NOT_OBSERVED if position is None else position for position in listed]
    positions = array_from_json(
        filled, (len(filled), 3) if filled else (0,), f"{location}, positions"
    )
    states, confidence = (
        None
        if frame.get(key) is None
        else array_from_json(frame[key], (len(filled),), f"{location}, {key}")
        for key in ("states", "confidence")
    )
    time = float(array_from_json(frame.get("time"), (), f"{location}, time"))
    return JointValues(positions.reshape(-1, 3), states, confidence, time)


def _check(names: list[str], frames: list[JointValues], path: Path | str) -> None:
    """Raise InvalidFileError unless each frame has a position for each joint."""
    if not names or not frames:
        raise InvalidFileError(f"{path} has no joints or no frames.")
    if duplicates := [name for name, times in Counter(names).items() if times > 1]:
        raise InvalidFileError(
            f"{path}: more than one joint is called {shown(duplicates[0])!r}; names must"
            " differ."
        )
    for number, frame in enumerate(frames, start=1):
        if len(frame.positions) != len(names):
            raise InvalidFileError(
                f"{path}, frame {number}: {len(frame.positions)} positions for"
                f" {len(names)} joints. Export the file again."
            )


def _stacked(values: list[NDArray[np.float64] | None]) -> NDArray[np.float64] | None:
    """Stack the values of all frames; NaN for frames without values; None without any."""
    given = next((value for value in values if value is not None), None)
    if given is None:
        return None
    nothing = np.full_like(given, np.nan)
    return np.asarray(np.stack([nothing if value is None else value for value in values]))
