"""Bones as lines whose colours tell how far their joints were trusted, as plain arrays."""

from typing import NamedTuple

import bpy
import numpy as np
from numpy.typing import NDArray

from ..actions.reliability_curves import Term, kept_terms, reliability_at
from ..blender.compat import Source
from ..scene import history

Array = NDArray[np.float32]
SHADES = np.array([
    [0.85, 0.07, 0.10, 1.0],  # not trusted
    [0.98, 0.72, 0.10, 1.0],
    [0.25, 0.62, 0.95, 1.0],  # trusted
], np.float32)  # fmt: skip
"""From 0 over one half to 1; told apart by the colour-blind too."""
UNKNOWN = np.array([0.5, 0.5, 0.5, 0.6], np.float32)


class Heat(NamedTuple):
    """Lines of the bones, and the joints as points, in the armature's own space."""

    ends: Array
    """Shape (n_bones, 2, 3): head and tail."""
    colors: Array
    """Of these, shape (n_bones, 2, 4)."""


def shade(reliability: float) -> Array:
    """Return the colour of a reliability, red for 0 to blue for 1; grey for NaN."""
    if not np.isfinite(reliability):
        return UNKNOWN
    places = np.linspace(0.0, 1.0, len(SHADES))
    columns = [np.interp(reliability, places, column) for column in SHADES.T]
    return np.array(columns, np.float32)


def trusted_source(armature: bpy.types.Object) -> Source | None:
    """Return what an armature plays, whose trust is told: a result, or its own action."""
    played = history.played_result(armature)
    animation = armature.animation_data
    if played is None and animation is not None and animation.action and animation.action_slot:
        return animation.action, animation.action_slot
    return played


def terms_told(armature: bpy.types.Object) -> frozenset[Term]:
    """Return what the result that an armature plays says of how far joints were trusted."""
    source = trusted_source(armature)
    return frozenset() if source is None else kept_terms(source)


def heat_at(
    armature: bpy.types.Object, frame: float, term: Term = Term.COMBINED
) -> Heat | None:
    """Return the posed bones of an armature in the colours of a frame.

    A bone goes from the colour of its own joint to that of the joint at its tail.
    """
    source = trusted_source(armature)
    bones = list(armature.pose.bones)
    if source is None or not bones:
        return None
    trusted = reliability_at(source, [bone.name for bone in bones], frame, term)
    if not trusted:
        return None
    ends = np.array([[bone.head, bone.tail] for bone in bones], np.float32)
    own = np.array([shade(trusted.get(bone.name, np.nan)) for bone in bones])
    far = np.array([_at_the_tail(bone, trusted) for bone in bones])
    return Heat(ends, np.stack([own, far], axis=1))


def _at_the_tail(bone: bpy.types.PoseBone, trusted: dict[str, float]) -> Array:
    """Return the colour of the joint at the tail of a bone; its own where there is none."""
    there = [child for child in bone.children if (child.head - bone.tail).length < 1e-4]
    names = [child.name for child in there] or [bone.name]
    return shade(min(trusted.get(name, np.nan) for name in names))
