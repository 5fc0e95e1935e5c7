"""Limit Rotation constraints of a rig, as joint limits."""

from collections.abc import Collection, Iterator
from math import inf

import bpy
import numpy as np

from ...solvers.motion import JointLimits
from ...solvers.rotations import multiply
from .take import ArmatureTake


def has_limits(armature: bpy.types.Object) -> bool:
    """Whether constraints limit the rotation of any bone."""
    return any(any(_limiting(bone)) for bone in armature.pose.bones)


def read_limits(
    armature: bpy.types.Object, take: ArmatureTake, bones: Collection[str]
) -> JointLimits | None:
    """Read the constraints that limit these bones' own rotations; None where there are none.

    Constraints in other spaces than the bone's own are left out, and so are those of the bones
    that carry a whole part, whose rotation is the world's.
    """
    world = multiply(take.rest.rotations[0], take.rig.rest_rotations)
    roots = {part.bones[0] for part in take.parts}
    names, axes, orders, lower, upper = [], [], [], [], []
    for index, name in enumerate(take.rig.bones):
        bone = armature.pose.bones[name]
        skipped = index in roots or name not in bones
        for constraint in () if skipped else _limiting(bone):
            order = _order(constraint, bone)
            bounds = [_bounds(constraint, axis) for axis in order]
            names.append(name)
            axes.append(world[index])
            orders.append(order)
            lower.append([low for low, _ in bounds])
            upper.append([high for _, high in bounds])
    if not names:
        return None
    by_role = np.zeros(len(names), bool)
    sides = np.array(axes)
    return JointLimits(
        tuple(names), by_role, sides, sides, tuple(orders), np.array(lower), np.array(upper)
    )


def _limiting(bone: bpy.types.PoseBone) -> Iterator[bpy.types.LimitRotationConstraint]:
    for constraint in bone.constraints:
        if constraint.type != "LIMIT_ROTATION" or constraint.mute or not constraint.influence:
            continue
        if constraint.owner_space == "LOCAL":
            yield constraint


def _order(constraint: bpy.types.LimitRotationConstraint, bone: bpy.types.PoseBone) -> str:
    """Return the Euler order, about moving axes: the reverse of Blender's name for it."""
    order: str = constraint.euler_order
    if order == "AUTO":
        order = bone.rotation_mode if len(bone.rotation_mode) == 3 else "XYZ"
    return order[::-1]


def _bounds(constraint: bpy.types.LimitRotationConstraint, axis: str) -> tuple[float, float]:
    axis = axis.lower()
    if not getattr(constraint, f"use_limit_{axis}"):
        return -inf, inf
    return getattr(constraint, f"min_{axis}"), getattr(constraint, f"max_{axis}")
