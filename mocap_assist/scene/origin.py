"""Where a recording came from, kept on what was made of it."""

import json
from pathlib import Path
from typing import Any

import bpy

from ...solvers.json_text import parse_json
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.motion.depth_recording import DepthRecording

ORIGIN = "mocap_assist_recording"


def note_origin(made: bpy.types.ID, origin: dict[str, Any]) -> None:
    """Keep the file, the kind of recording, its rate and its sensor, as JSON."""
    made[ORIGIN] = json.dumps(origin, ensure_ascii=False)


def origin_of_file(
    path: Path, recording: Motion | Tracks | JointRecording | DepthRecording
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
    return origin


def origin_of(made: bpy.types.ID) -> dict[str, Any]:
    """Return what was noted; nothing for what was not imported here."""
    try:
        origin = parse_json(made.get(ORIGIN, "{}"))
    except (TypeError, ValueError):  # edited by hand
        return {}
    return origin if isinstance(origin, dict) else {}
