"""Curves that Track adds to an action: how well each frame was explained."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..actions.curves import write_first, write_values
from ..actions.reliability_curves import reliability_path, write_reliability
from ..blender import compat
from ..blender.compat import Source

Array = NDArray[np.float64]

RESIDUAL = "mocap_residual"
"""Custom property of the armature: metres between body and points, keyed."""


def write_residual(
    armature: bpy.types.Object, source: Source, frames: Array, residual: Array
) -> None:
    """Key how far the body lies beside the points, metres; not where that is NaN."""
    known = np.isfinite(residual)
    if not known.any():
        return
    frames, residual = frames[known], residual[known]
    bag = compat.ensure_channelbag(*source)
    if curve := bag.fcurves.find(_PATH):
        write_values(curve, frames, residual)
        return
    armature[RESIDUAL] = float(residual[0])
    write_first(compat.new_curve(bag, _PATH, 0, "Track"), frames, residual)


_PATH = f'["{RESIDUAL}"]'


def mend_trust(
    armature: bpy.types.Object,
    source: Source,
    frames: Array,
    rows: slice,
    trusted: dict[str, Array],
) -> dict[str, Array]:
    """Key how far joints are trusted in some of these frames, and return it for all of them.

    Bones of which the action tells nothing are left out.
    """
    bag = compat.ensure_channelbag(*source)
    known = {}
    for bone, values in trusted.items():
        curve = bag.fcurves.find(reliability_path(bone))
        if curve is None:
            continue
        whole = np.array([curve.evaluate(frame) for frame in frames])
        whole[rows] = values
        known[bone] = whole
    write_reliability(armature, *source, frames, known)
    return known
