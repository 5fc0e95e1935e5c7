"""Origin of a recording, stored on its objects and actions."""

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, get_args

import bpy

from ...solvers.depth_scene import DepthRecording
from ...solvers.motion import AxisName, FileConventions, JointRecording, Motion, Tracks
from ...solvers.recordings.conventions import conventions_of
from ..blender.stored_json import load_json, store_json

ORIGIN = "mocap_assist_recording"
NOTED: dict[str, Any] = {
    "file": str, "kind": str, "frame_rate": int | float, "n_frames": int, "sensor": str,
    "body": str, "up": str, "forward": str, "unit": int | float, "rest_up": str,
    "offset_added": bool, "confidence": int | float, "has_floor": bool, "scale": int | float,
    "is_unit_guessed": bool, "stated_up": str, "is_mirrored": bool,
}  # fmt: skip
"""Keys of a note, and the types of valid values."""


def note_origin(made: bpy.types.ID, origin: dict[str, Any]) -> None:
    """Keep the file, the kind of recording, its rate and its sensor, as JSON."""
    store_json(made, ORIGIN, origin)


def origin_of_file(
    path: Path,
    recording: Motion | Tracks | JointRecording | DepthRecording,
    scale: float = 1.0,
    body: str = "",
) -> dict[str, Any]:
    """Return what is to be noted about a recording that was read from a file, and scaled."""
    origin = {
        "file": str(path),
        "kind": type(recording).__name__,
        "frame_rate": recording.frame_rate,
        "n_frames": recording.n_frames,
    }
    if isinstance(recording, JointRecording):
        origin["sensor"] = recording.sensor.value
    if body:
        origin["body"] = body
    if not isinstance(recording, DepthRecording):
        origin |= asdict(conventions_of(recording)) | {"scale": scale}
    return origin


def was_tracked(made: bpy.types.ID) -> bool:
    """Whether it was imported from the joints of a depth camera."""
    return bool(origin_of(made).get("kind") == JointRecording.__name__)


def noted_conventions(origin: dict[str, Any]) -> FileConventions | None:
    """Return the axes and unit of a note; None if it has none, or they make no sense."""
    names = [item.name for item in fields(FileConventions)]
    noted = FileConventions(**{name: origin[name] for name in names if name in origin})
    axes = {noted.up, noted.forward, noted.rest_up or noted.up, noted.stated_up or noted.up}
    known = axes <= {*get_args(AxisName)}
    is_valid = known and noted.up[-1] != noted.forward[-1] and noted.unit > 0.0
    return noted if is_valid and {"up", "forward", "unit"} <= origin.keys() else None


def origin_of(made: bpy.types.ID) -> dict[str, Any]:
    """Return what was noted; nothing for what was not imported here."""
    noted = load_json(made, ORIGIN, dict)
    return {
        name: noted[name] for name, kind in NOTED.items() if isinstance(noted.get(name), kind)
    }
