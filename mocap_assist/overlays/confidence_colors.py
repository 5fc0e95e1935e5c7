"""Bones as lines with the colors of the reliability of their joints, as plain arrays."""

from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Single
from ..actions.reliability_curves import Term, reliability_at, stored_terms
from ..blender.compat import Source
from ..scene import history
from ..scene.played_time import played_time

COLORS = np.array([
    [0.85, 0.07, 0.10, 1.0],  # unreliable
    [0.98, 0.72, 0.10, 1.0],
    [0.25, 0.62, 0.95, 1.0],  # reliable
], np.float32)  # fmt: skip
"""Colors of reliabilities 0, 0.5 and 1; color-blind users can distinguish them."""
UNKNOWN = np.array([0.5, 0.5, 0.5, 0.6], np.float32)


class ColoredBones(NamedTuple):
    """Lines of the bones, and the joints as points, in the armature's own space."""

    ends: Single
    """Shape (n_bones, 2, 3): head and tail."""
    colors: Single
    """Of these, shape (n_bones, 2, 4)."""


def color_from_reliability(reliability: float) -> Single:
    """Return the color of a reliability, red for 0 to blue for 1; gray for NaN."""
    if not np.isfinite(reliability):
        return UNKNOWN
    knots = np.linspace(0.0, 1.0, len(COLORS))
    columns = [np.interp(reliability, knots, column) for column in COLORS.T]
    return np.array(columns, np.float32)


def reliability_source(armature: bpy.types.Object) -> Source | None:
    """Return the result or action of an armature that may hold reliabilities."""
    played = history.played_result(armature)
    animation = armature.animation_data
    if played is None and animation is not None and animation.action and animation.action_slot:
        return animation.action, animation.action_slot
    return played


def available_terms(armature: bpy.types.Object) -> frozenset[Term]:
    """Return the reliability terms that the result or action of an armature holds."""
    source = reliability_source(armature)
    return frozenset() if source is None else stored_terms(source)


def colored_bones_at(
    armature: bpy.types.Object, frame: float, term: Term = Term.COMBINED
) -> ColoredBones | None:
    """Return the posed bones of an armature in the colors of a scene frame.

    A bone blends from the color of its own joint to that of the joint at its tail.
    """
    source = reliability_source(armature)
    bones = list(armature.pose.bones)
    if source is None or not bones:
        return None
    frame = played_time(armature, frame).action_frame(frame)
    reliabilities = reliability_at(source, [bone.name for bone in bones], frame, term)
    if not reliabilities:
        return None
    ends = np.array([[bone.head, bone.tail] for bone in bones], np.float32)
    head_colors = np.array([
        color_from_reliability(reliabilities.get(bone.name, np.nan)) for bone in bones
    ])
    tail_colors = np.array([_at_the_tail(bone, reliabilities) for bone in bones])
    return ColoredBones(ends, np.stack([head_colors, tail_colors], axis=1))


def _at_the_tail(bone: bpy.types.PoseBone, reliabilities: dict[str, float]) -> Single:
    """Return the color of the joint at the tail of a bone; without one, of its own joint."""
    children = [child for child in bone.children if (child.head - bone.tail).length < 1e-4]
    names = [child.name for child in children] or [bone.name]
    return color_from_reliability(min(reliabilities.get(name, np.nan) for name in names))
