"""Sensor confidence of joints and markers: custom properties, keyed where they change."""

from collections.abc import Mapping, Sequence
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion import JointRecording, Motion, Tracks
from ..blender import compat
from .bone_channels import bone_path
from .curves import CONSTANT, write_first

CONFIDENCE = "mocap_confidence"
"""Custom property of a bone or an empty: the sensor's confidence, 0 to 1."""
STATE = "mocap_tracking_state"
"""Likewise: 2 tracked, 1 inferred from other joints, 0 not tracked."""
TRACKED = 2.0


def sensor_values(recording: Motion | Tracks | JointRecording) -> dict[str, dict[str, Array]]:
    """Return the sensor's values, shape (n_frames,), by point and then by property."""
    if isinstance(recording, Motion):
        return {}
    state = recording.tracking_state if isinstance(recording, JointRecording) else None
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    states: dict[str, NDArray[Any] | None] = {CONFIDENCE: tracks.confidence, STATE: state}
    return {
        name: {kind: values[:, point] for kind, values in states.items() if values is not None}
        for point, name in enumerate(tracks.names)
    }


def write_sensor_values(
    bag: bpy.types.ActionChannelbag,
    owner: bpy.types.Object | bpy.types.PoseBone,
    frames: Array,
    words: Mapping[str, Array],
) -> None:
    """Key custom properties of a bone or an empty, constant from one key to the next."""
    path, group = "", "Sensor"
    if isinstance(owner, bpy.types.PoseBone):
        path, group = owner.path_from_id(), owner.name
    for name, values in words.items():
        owner[name] = values[0].item()
        curve = compat.new_curve(bag, f'{path}["{name}"]', 0, group)
        changes = np.append(True, values[1:] != values[:-1])
        write_first(curve, frames[changes], values[changes].astype(float), CONSTANT)


def read_states(
    source: compat.Source, bones: Sequence[str], frames: Array
) -> NDArray[np.int8] | None:
    """Return the tracking state of each bone's joint, shape (n_frames, n_bones): 2, 1, 0.

    A bone without a state counts as tracked; None if no bone has a state.
    """
    bag = compat.channelbag(*source)
    if bag is None:
        return None
    paths = [f'{bone_path(bone, "").removesuffix(".")}["{STATE}"]' for bone in bones]
    curves = [bag.fcurves.find(path) for path in paths]
    if not any(curves):
        return None
    states = np.full((len(frames), len(curves)), TRACKED)
    for column, curve in enumerate(curves):
        if curve is not None:
            states[:, column] = [curve.evaluate(frame) for frame in frames]
    return states.astype(np.int8)
