"""Constant location keys, which give bones other lengths than in the rest pose."""

from collections.abc import Mapping

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import Skeleton
from ...solvers.rotations import inverse, multiply, rotate
from ..blender import compat
from .bone_channels import bone_path
from .curves import write_first
from .take import ArmatureTake


def key_lengths(
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    locations: Mapping[str, Array],
    frame: float,
) -> None:
    """Give bones a constant location, replacing the keys that they have.

    Keys of 0 in a recorded action keep the locations of a result from showing in it.

    Parameters
    ----------
    action, slot : where the keys are written
    locations : per bone name, shape (3,), in the armature's unit
    frame : of the key
    """
    bag = compat.ensure_channelbag(action, slot)
    for bone, location in locations.items():
        path = bone_path(bone, "location")
        for axis, value in enumerate(location):
            curve = bag.fcurves.find(path, index=axis)
            if curve is not None:
                bag.fcurves.remove(curve)
            curve = compat.new_curve(bag, path, axis, bone)
            write_first(curve, np.array([frame]), np.array([value]))


def has_constant_locations(take: ArmatureTake) -> bool:
    """Whether all bones of the body below its root have location keys that never change."""
    bones = [bone for bone in take.parts[0].bones[1:] if bone >= 0]
    return all(
        take.channels[bone].location_keyed and not take.channels[bone].travels for bone in bones
    )


def length_locations(take: ArmatureTake, skeleton: Skeleton) -> dict[str, Array]:
    """Return the location of each bone that gives the body of a take other offsets.

    Parameters
    ----------
    take : ArmatureTake
        Of the armature, with any locations.
    skeleton : Skeleton
        Of the same joints.

    Returns
    -------
    dict of bone name to shape (3,), in the armature's unit
    """
    body, rig, rest = take.parts[0], take.rig, take.rest
    world = multiply(rest.rotations[0], rig.rest_rotations)
    shift = (skeleton.offsets - body.motion.skeleton.offsets) / rest.scale
    return {
        rig.bones[bone]: rotate(inverse(world[bone]), shift[joint])
        + take.channels[bone].locations[0]
        for joint, bone in enumerate(body.bones)
        if joint > 0 and bone >= 0
    }
