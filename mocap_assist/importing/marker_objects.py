"""Markers of a recording as empties with sticks; computed points in a hidden collection."""

from collections.abc import Sequence
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.markers import find_marker_sticks, find_model_outputs
from ...solvers.motion import Tracks
from ...solvers.progress import Progress
from ..actions.markers.empties import build_empties, write_tracks
from ..actions.sensor_notes import write_sensor_values
from ..blender import compat
from ..markers.sticks import build_sticks
from ..scene.scene_objects import hidden_collection
from ..scene.units import unit_of
from .sensor_samples import SensorSamples

OUTPUTS = "model outputs"


class Timed(NamedTuple):
    """Points, their scene frames, and what the sensor reported."""

    tracks: Tracks
    frames: Array
    sensor_samples: SensorSamples

    def of(self, points: Sequence[int]) -> "Timed":
        """Return some of the points."""
        tracks = self.tracks
        confidence = None if tracks.confidence is None else tracks.confidence[:, points]
        names = tuple(tracks.names[point] for point in points)
        some = Tracks(names, tracks.positions[:, points], tracks.frame_rate, confidence)
        return self._replace(tracks=some)


def make_markers(
    context: bpy.types.Context,
    name: str,
    timed: Timed,
    parents: Sequence[int] | None,
    progress: Progress,
) -> tuple[bpy.types.Object, bpy.types.Action, tuple[str, ...]]:
    """Add empties; return their parent, their action, and a description.

    `parents` are those of joints; None for markers, whose sticks follow from their names.
    """
    names = timed.tracks.names
    outputs = () if parents is not None else find_model_outputs(names)
    measured = [point for point in range(len(names)) if point not in set(outputs)]
    if not measured:
        measured, outputs = list(outputs), ()
    shown = timed.of(measured)
    holder, empties, action = _make(context, name, shown, progress)
    if parents is None:
        pairs = find_marker_sticks(shown.tracks.names)
    else:
        pairs = tuple((parent, joint) for joint, parent in enumerate(parents) if parent >= 0)
    build_sticks(context, holder, empties, pairs)
    what: tuple[str, ...] = (f"{len(measured)} empties",)
    if outputs:
        collection = hidden_collection(context, f"{name} {OUTPUTS}")
        computed = timed.of(outputs)
        below, _, _ = _make(context, f"{name} {OUTPUTS}", computed, progress, collection)
        below.parent = holder
        what = (*what, f"and {len(outputs)} computed points in a hidden collection")
    return holder, action, what


def observed_points(tracks: Tracks) -> list[int]:
    """Return the points that were ever observed: others would appear at the origin."""
    return [int(point) for point in np.flatnonzero(tracks.visible.any(axis=0))]


def _make(
    context: bpy.types.Context,
    name: str,
    timed: Timed,
    progress: Progress,
    collection: bpy.types.Collection | None = None,
) -> tuple[bpy.types.Object, tuple[bpy.types.Object, ...], bpy.types.Action]:
    tracks, meters = timed.tracks, unit_of(context.scene)
    holder, empties = build_empties(context, name, tracks.names, meters, collection)
    action = write_tracks(name, empties, tracks, timed.frames, meters, progress=progress)
    for point, empty in zip(tracks.names, empties, strict=True):
        write_sensor_values(
            compat.channelbag(action, empty.animation_data.action_slot),
            empty,
            *timed.sensor_samples.of(point),
        )
    return holder, empties, action
