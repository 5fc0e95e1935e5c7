"""Recorded F-Curves behind those of a result, as plain arrays for the Graph Editor."""

from collections.abc import Iterator
from typing import NamedTuple

import bpy
import numpy as np

from ....solvers.arrays import Array, Single
from ...actions.curves import Channel
from ...blender import compat
from ...scene import history
from ...scene.played_time import PlayedTime, played_time
from ..marked_ranges import MAX_STEPS_BETWEEN

MAX_CURVES = 64
"""Number of curves with a recorded one behind them. It bounds the time of a drawing."""


class CurvePair(NamedTuple):
    """F-Curve of a result, and the recorded one of the same channel."""

    played: bpy.types.FCurve
    recorded: bpy.types.FCurve
    recorded_in: tuple[int, int]
    """Number of the recorded action in this session, and handle of its slot: in one action,
    the curves of many markers have the same data path."""
    time: PlayedTime
    """Of both: in Tweak Mode the editor shows keys at the frames of the strip."""


def shown_pairs(context: bpy.types.Context) -> list[CurvePair]:
    """Return the curves that a Graph Editor shows of results, with their recorded curves."""
    visible = list(context.visible_fcurves or ())[:MAX_CURVES]
    found: list[CurvePair] = []
    for player in _players(context):
        found += _pairs_of(player, visible)
    return found


def _players(context: bpy.types.Context) -> Iterator[bpy.types.Object]:
    active = context.view_layer.objects.active
    if active is not None:
        yield active
    yield from (each for each in context.selected_objects if each != active)


def _pairs_of(player: bpy.types.Object, visible: list[bpy.types.FCurve]) -> Iterator[CurvePair]:
    played = history.played_result(player)
    recorded = played and history.raw_of(*played)
    if not (played and recorded):
        return
    time = played_time(player)
    bag, recorded_bag = compat.channelbag(*played), compat.channelbag(*recorded)
    if bag is None or recorded_bag is None:
        return
    recorded_in = recorded[0].session_uid, recorded[1].handle
    for curve in visible:
        path, index = curve.data_path, curve.array_index
        if curve.id_data != played[0] or bag.fcurves.find(path, index=index) != curve:
            continue
        behind = recorded_bag.fcurves.find(path, index=index)
        if behind is not None and len(behind.keyframe_points) > 1:  # a line has two ends
            yield CurvePair(curve, behind, recorded_in, time)


def curve_lines(curve: bpy.types.FCurve) -> Single:
    """Return lines from key to key, shape (n_lines, 2, 3); none over a gap of the recording.

    Columns are the frame, the value and 0.
    """
    keys = Channel(curve).keys
    steps = np.diff(keys[:, 0])
    observed = steps <= MAX_STEPS_BETWEEN * (np.median(steps) if len(steps) else 1.0)
    points = np.zeros((len(keys), 3), np.float32)
    points[:, :2] = keys
    lines: Single = np.stack([points[:-1], points[1:]], axis=1)[observed]
    return lines


def displayed_values(
    curve: bpy.types.FCurve, scene: bpy.types.Scene, *, normalized: bool
) -> tuple[float, float]:
    """Return factor and offset from a value of a curve to its height in the Graph Editor.

    Blender shows angles in degrees, or all curves from -1 to 1 if they are normalized.
    """
    if normalized:
        return _normalization(Channel(curve).keys, scene)
    in_degrees = scene.unit_settings.system_rotation == "DEGREES"
    is_angle = curve.data_path.endswith("rotation_euler")
    return (float(np.degrees(1.0)) if in_degrees and is_angle else 1.0), 0.0


def _normalization(keys: Array, scene: bpy.types.Scene) -> tuple[float, float]:
    if scene.use_preview_range:
        first, last = scene.frame_preview_start, scene.frame_preview_end
        inside = (keys[:, 0] >= first) & (keys[:, 0] <= last)
        keys = keys[inside] if inside.any() else keys
    if not len(keys):
        return 1.0, 0.0
    low, high = keys[:, 1].min(), keys[:, 1].max()
    factor = 2.0 / (high - low) if high > low else 1.0
    return float(factor), float(-0.5 * (low + high) * factor)
