"""Replace many keys by few keys with handles."""

import re
from collections.abc import Mapping

import numpy as np

from ...solvers.retargeting import KeyCurve
from ..actions.armature_write import same_slot
from ..actions.bone_channels import Curves, animated_curves, location_curves, rotation_curves
from ..actions.curves import Channel
from ..actions.frames import Grid
from ..blender.block_references import SourceReference, kept_when_complete
from ..blender.compat import Source
from ..blender.time_slices import Sliced, Steps, should_yield
from ..runtime.played import Played
from .solve_unbaking import SparseKeys

SUFFIX = ".sparse"
NUMBERED = re.compile(r"\.sparse(\.\d{3,})?$")
BEZIER, ALIGNED = 2, 3  # Blender's numbers


@Sliced
def write_sparse(read: Played, grid: Grid, keys: Mapping[str, SparseKeys]) -> Steps[Source]:
    """Copy an action and replace all keys of some bones' rotations and locations.

    Parameters
    ----------
    read : the armature, and the action that was read from it
    grid : Grid
        The frames that were read.
    keys : by bone
        All else is copied bit for bit.
    """
    _, armature, (original, slot) = read.find()
    action = original.copy()
    action.name = NUMBERED.sub("", original.name) + SUFFIX
    made = SourceReference.of((action, same_slot(action, slot)))
    curves = animated_curves(*made.find())
    with kept_when_complete(action):
        for number, (name, sparse) in enumerate(keys.items()):
            bone = armature.pose.bones[name]
            if sparse.rotations is not None:
                _write(rotation_curves(bone, curves), grid, sparse.rotations)
            if sparse.locations is not None:
                _write(location_curves(bone, curves), grid, sparse.locations)
            if should_yield():
                yield number / len(keys)
                _, armature, _ = read.find()
                curves = animated_curves(*made.find())
    return made.find()


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
