"""How well a sensor saw each joint or marker: custom properties, keyed where they change."""

from collections.abc import Mapping, Sequence
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.motion import JointRecording, Motion, Tracks
from ..blender import compat
from .bone_channels import bone_path
from .curves import CONSTANT, write_first

Array = NDArray[np.float64]
CONFIDENCE = "mocap_confidence"
"""Custom property of a bone or an empty: 0 to 1, how sure the sensor is of it."""
STATE = "mocap_tracking_state"
"""Likewise: 2 tracked, 1 inferred from other joints, 0 not tracked."""
TRACKED = 2.0


def words_of(recording: Motion | Tracks | JointRecording) -> dict[str, dict[str, Array]]:
    """Return what the sensor said, shape (n_frames,), by point and then by property."""
    if isinstance(recording, Motion):
        return {}
    state = recording.tracking_state if isinstance(recording, JointRecording) else None
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    said: dict[str, NDArray[Any] | None] = {CONFIDENCE: tracks.confidence, STATE: state}
    return {
        name: {kind: values[:, point] for kind, values in said.items() if values is not None}
        for point, name in enumerate(tracks.names)
    }


def write_words(
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
    """Return what the sensor said of each bone's joint, shape (n_frames, n_bones): 2, 1, 0.

    A bone of which nothing was said counts as tracked; None where nothing was said of any.
    """
    bag = compat.channelbag(*source)
    if bag is None:
        return None
    paths = [f'{bone_path(bone, "").removesuffix(".")}["{STATE}"]' for bone in bones]
    curves = [bag.fcurves.find(path) for path in paths]
    if not any(curves):
        return None
    said = np.full((len(frames), len(curves)), TRACKED)
    for place, curve in enumerate(curves):
        if curve is not None:
            said[:, place] = [curve.evaluate(frame) for frame in frames]
    return said.astype(np.int8)
