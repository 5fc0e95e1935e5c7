"""Limit Rotation constraints of a rig, as joint limits."""

from collections.abc import Collection, Iterable, Iterator
from math import inf

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import JointLimits
from ...solvers.rotations import multiply
from ..scene.controls import TargetRig
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
    return _limits_of(
        armature,
        [
            (name, name, world[index])
            for index, name in enumerate(take.rig.bones)
            if index not in roots and name in bones
        ],
    )


def target_limits(armature: bpy.types.Object, target: TargetRig) -> JointLimits | None:
    """Read the constraints of controls that rotate a joint relative to the one above it.

    The limits hold for the joints of the target. Controls that something else carries, such as
    those of IK, have none.
    """
    skeleton, limited = target.skeleton, []
    for control in target.controls:
        if not control.rotates or control.joint < 0 or control.carrier < 0:
            continue
        if target.controls[control.carrier].joint == skeleton.parents[control.joint]:
            limited.append((control.bone, skeleton.names[control.joint], control.axes))
    return _limits_of(armature, limited)


def _limits_of(
    armature: bpy.types.Object, bones: Iterable[tuple[str, str, Array]]
) -> JointLimits | None:
    """Return the limits of bones, which have a name, that of their joint, and rest axes."""
    names, axes, orders, lower, upper = [], [], [], [], []
    for bone_name, joint_name, rest in bones:
        bone = armature.pose.bones[bone_name]
        for constraint in _limiting(bone):
            order = _order(constraint, bone)
            bounds = [_bounds(constraint, axis) for axis in order]
            names.append(joint_name)
            axes.append(rest)
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
