"""Where a recording came from, kept on what was made of it."""

from pathlib import Path
from typing import Any

import bpy

from ...solvers.depth_scene import DepthRecording
from ...solvers.motion import JointRecording, Motion, Tracks
from ..blender.stored_json import load_json, store_json

ORIGIN = "mocap_assist_recording"
NOTED: dict[str, Any] = {
    "file": str, "kind": str, "frame_rate": int | float, "n_frames": int, "sensor": str,
    "body": str,
}  # fmt: skip
"""Keys of a note, and the types of valid values."""


def note_origin(made: bpy.types.ID, origin: dict[str, Any]) -> None:
    """Keep the file, the kind of recording, its rate and its sensor, as JSON."""
    store_json(made, ORIGIN, origin)


def origin_of_file(
    path: Path, recording: Motion | Tracks | JointRecording | DepthRecording, body: str = ""
) -> dict[str, Any]:
    """Return what is to be noted about a recording that was read from a file."""
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
    return origin


def origin_of(made: bpy.types.ID) -> dict[str, Any]:
    """Return what was noted; nothing for what was not imported here."""
    noted = load_json(made, ORIGIN, dict)
    return {
        name: noted[name] for name, kind in NOTED.items() if isinstance(noted.get(name), kind)
    }
