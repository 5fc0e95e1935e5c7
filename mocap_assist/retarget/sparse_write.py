"""Replace many keys by few keys with handles."""

import re
from collections.abc import Mapping

import bpy
import numpy as np

from ...solvers.retargeting import KeyCurve
from ..actions.bone_channels import Curves, animated_curves, location_curves, rotation_curves
from ..actions.curves import Channel
from ..actions.frames import Grid
from ..blender.compat import Source
from .solve_unbaking import SparseKeys

SUFFIX = ".sparse"
NUMBERED = re.compile(r"\.sparse(\.\d{3,})?$")
BEZIER, ALIGNED = 2, 3  # Blender's numbers


def write_sparse(
    armature: bpy.types.Object, source: Source, grid: Grid, keys: Mapping[str, SparseKeys]
) -> Source:
    """Copy an action and replace all keys of some bones' rotations and locations.

    Parameters
    ----------
    armature : the armature that the action was read from
    source : action and slot; may be linked
    grid : Grid
        The frames that were read.
    keys : by bone
        All else is copied bit for bit.
    """
    original, slot = source
    action = original.copy()
    action.name = NUMBERED.sub("", original.name) + SUFFIX
    action.use_fake_user = True
    slot = next(each for each in action.slots if each.handle == slot.handle)
    curves = animated_curves(action, slot)
    for name, sparse in keys.items():
        bone = armature.pose.bones[name]
        if sparse.rotations is not None:
            _write(rotation_curves(bone, curves), grid, sparse.rotations)
        if sparse.locations is not None:
            _write(location_curves(bone, curves), grid, sparse.locations)
    return action, slot


def count_keys(curves: Curves) -> int:
    """Count the keys of all channels."""
    return sum(len(channel.curve.keyframe_points) for channel in curves.values())


def _write(channels: Mapping[int, Channel], grid: Grid, keys: KeyCurve) -> None:
    handle_frames, handle_values = keys.handles()
    times, handle_times = (
        grid.frames[0] + grid.step * each for each in (keys.frames, handle_frames)
    )
    for index, channel in channels.items():
        points = channel.curve.keyframe_points
        points.clear()
        points.add(len(times))
        values = handle_values[:, :, index]
        columns = {
            "co": np.stack([times, keys.values[:, index]], axis=1),
            "handle_left": np.stack([handle_times[:, 0], values[:, 0]], axis=1),
            "handle_right": np.stack([handle_times[:, 1], values[:, 1]], axis=1),
        }
        for kind in ("handle_left_type", "handle_right_type"):
            points.foreach_set(kind, np.full(len(times), ALIGNED, np.uint8))
        points.foreach_set("interpolation", np.full(len(times), BEZIER, np.uint8))
        for name, column in columns.items():
            points.foreach_set(name, column.astype(np.float32).ravel())
        channel.curve.update()
