"""Curves that Track adds to an action: fit and confidence of each frame."""

import bpy
import numpy as np

from ....solvers.arrays import Array
from ...actions.curves import write_first, write_values
from ...actions.reliability_curves import reliability_path, write_reliability
from ...blender import compat
from ...blender.compat import Source

RESIDUAL = "mocap_residual"
"""Keyed custom property of the armature: distance of body and points in meters."""


def write_residual(
    armature: bpy.types.Object, source: Source, frames: Array, residual: Array
) -> None:
    """Key the distance of body and points in meters, except where it is NaN."""
    observed = np.isfinite(residual)
    if not observed.any():
        return
    frames, residual = frames[observed], residual[observed]
    bag = compat.ensure_channelbag(*source)
    if curve := bag.fcurves.find(_PATH):
        write_values(curve, frames, residual)
        return
    armature[RESIDUAL] = float(residual[0])
    write_first(compat.new_curve(bag, _PATH, 0, "Track"), frames, residual)


_PATH = f'["{RESIDUAL}"]'


def update_reliability(
    armature: bpy.types.Object,
    source: Source,
    frames: Array,
    rows: slice,
    changed: dict[str, Array],
) -> dict[str, Array]:
    """Key the reliability of joints in some of these frames, and return it for all of them.

    Bones without a reliability curve in the action are left out.
    """
    bag = compat.ensure_channelbag(*source)
    reliability = {}
    for bone, values in changed.items():
        curve = bag.fcurves.find(reliability_path(bone))
        if curve is None:
            continue
        merged = np.array([curve.evaluate(frame) for frame in frames])
        merged[rows] = values
        reliability[bone] = merged
    write_reliability(armature, *source, frames, reliability)
    return reliability
