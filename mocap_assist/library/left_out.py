"""Find movement of bones that a recording of rotations cannot hold, such as stretching."""

from collections.abc import Sequence

import bpy
import numpy as np

from ...solvers.arrays import Array
from ..actions.bone_channels import animated_curves, bone_path
from ..actions.take import ArmatureTake
from ..blender.compat import Source
from ..jobs.in_blender import LeftOut

MIN_SHIFT_M = 0.02
"""Change of a bone's distance to its parent, meters, from which it is reported. Chosen by hand:
half of the width of a wrist. It decides a sentence of the report only."""
MIN_GROWTH = 0.02
"""Difference of a bone's scale from 1, a ratio, from which it is reported. Chosen by hand: 1 cm
of a thigh. It decides a sentence of the report only."""


def find_left_out(source: Source, take: ArmatureTake) -> LeftOut:
    """Return the bones of the body whose shifts and sizes are left out of a take.

    Parameters
    ----------
    source : Source
        Action and slot of the take.
    take : ArmatureTake
    """
    body = take.parts[0].motion.skeleton.names
    shifts = {} if take.offsets is None else _shifts(take.offsets.names, take.offsets.positions)
    curves = animated_curves(*source)
    growing = [
        name
        for name in body
        if any(
            (channel := curves.get((bone_path(name, "scale"), axis))) is not None
            and _grows(channel.curve)
            for axis in range(3)
        )
    ]
    shifting = [(name, shifts[name]) for name in body if shifts.get(name, 0.0) >= MIN_SHIFT_M]
    return LeftOut(tuple(shifting), tuple(growing))


def _shifts(names: Sequence[str], positions: Array) -> dict[str, float]:
    """Return how far each bone moves within its parent, meters."""
    ranges = np.nanmax(positions, axis=0) - np.nanmin(positions, axis=0)
    return dict(zip(names, np.linalg.norm(ranges, axis=-1).tolist(), strict=True))


def _grows(curve: bpy.types.FCurve) -> bool:
    keys = np.empty((len(curve.keyframe_points), 2), np.float32)
    curve.keyframe_points.foreach_get("co", keys.ravel())
    return bool(np.any(np.abs(keys[:, 1] - 1.0) >= MIN_GROWTH))
