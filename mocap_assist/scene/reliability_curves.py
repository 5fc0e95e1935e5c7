"""How far each joint was trusted: a keyed custom property of bones, kept in a result."""

from collections.abc import Mapping

import bpy
import numpy as np
from numpy.typing import NDArray

from . import compat
from .bone_channels import bone_path
from .compat import Source
from .curves import write_first

Array = NDArray[np.float64]
RELIABILITY = "mocap_reliability"
"""Custom property of a bone: 0 to 1, how far its joint was trusted."""
DIGITS = 2
"""Decimals that are kept: nobody sees finer shades, and steady stretches need few keys."""


def reliability_path(bone: str) -> str:
    """Return the data path of the property on a bone."""
    return f'{bone_path(bone, "").removesuffix(".")}["{RELIABILITY}"]'


def write_reliability(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frames: Array,
    reliability: Mapping[str, Array],
) -> None:
    """Key the property on each bone of which something is known, linear between changes."""
    bag = compat.channelbag(action, slot, ensure=True)
    for bone, values in reliability.items():
        if bone not in armature.pose.bones or not np.isfinite(values).all():
            continue
        shown = np.round(values, DIGITS)
        same = np.append(shown[1:] == shown[:-1], True)  # as the next one
        needed = ~(np.append(True, same[:-1]) & same)
        needed[[0, -1]] = True
        path = reliability_path(bone)
        if old := bag.fcurves.find(path):
            bag.fcurves.remove(old)
        if armature.library is None and armature.override_library is None:
            armature.pose.bones[bone][RELIABILITY] = float(shown[0])
        write_first(compat.new_curve(bag, path, 0, bone), frames[needed], shown[needed])


def reliability_at(source: Source, bones: list[str], frame: float) -> dict[str, float]:
    """Return how far the joint of each bone was trusted at a frame, where this is kept."""
    bag = compat.channelbag(*source)
    if bag is None:
        return {}
    curves = ((bone, bag.fcurves.find(reliability_path(bone))) for bone in bones)
    return {bone: curve.evaluate(frame) for bone, curve in curves if curve is not None}
