"""Reliability of each joint and its terms: keyed custom properties of bones, in a result."""

from collections.abc import Mapping
from enum import Enum

import bpy
import numpy as np

from ...solvers.arrays import Array
from ..blender import compat
from ..blender.compat import Source
from .bone_channels import bone_path
from .curves import write_first


class Term(Enum):
    """Term of the reliability; its value names the custom property of a bone, 0 to 1."""

    COMBINED = "mocap_reliability"
    BEHAVIOR = "mocap_reliability_behaviour"
    KINEMATICS = "mocap_reliability_kinematics"
    TRACKING = "mocap_reliability_tracking"


DIGITS = 2
"""Number of stored decimals: finer colors are not visible. It bounds the number of keys, as
equal values need none."""


def reliability_path(bone: str, term: Term = Term.COMBINED) -> str:
    """Return the data path of the property on a bone."""
    return f'{bone_path(bone, "").removesuffix(".")}["{term.value}"]'


def write_reliability(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    frames: Array,
    reliability: Mapping[str, Array],
    term: Term = Term.COMBINED,
) -> None:
    """Key the property on each bone with finite reliability, linear between changes."""
    bag = compat.ensure_channelbag(action, slot)
    for bone, values in reliability.items():
        if bone not in armature.pose.bones or not np.isfinite(values).all():
            continue
        shown = np.round(values, DIGITS)
        same = np.append(shown[1:] == shown[:-1], True)  # as the next one
        needed = ~(np.append(True, same[:-1]) & same)
        needed[[0, -1]] = True
        path = reliability_path(bone, term)
        if old := bag.fcurves.find(path):
            bag.fcurves.remove(old)
        if armature.library is None and armature.override_library is None:
            armature.pose.bones[bone][term.value] = float(shown[0])
        write_first(compat.new_curve(bag, path, 0, bone), frames[needed], shown[needed])


def reliability_at(
    source: Source, bones: list[str], frame: float, term: Term = Term.COMBINED
) -> dict[str, float]:
    """Return the reliability of the joint of each bone at a frame, where it is stored."""
    bag = compat.channelbag(*source)
    if bag is None:
        return {}
    curves = ((bone, bag.fcurves.find(reliability_path(bone, term))) for bone in bones)
    return {bone: curve.evaluate(frame) for bone, curve in curves if curve is not None}


def stored_terms(source: Source) -> frozenset[Term]:
    """Return the reliability terms stored on any bone."""
    bag = compat.channelbag(*source)
    if bag is None:
        return frozenset()
    ends = {f'["{term.value}"]': term for term in Term}
    paths = (curve.data_path for curve in bag.fcurves)
    return frozenset(ends.values()) & {ends.get(path[path.rfind("[") :]) for path in paths}
