"""Make an armature whose bones are those of a skeleton."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.motion import Skeleton
from ..blender.data_names import fitting_name
from ..scene.rig import END
from ..scene.scene_objects import add_object, in_object_mode

Array = NDArray[np.float64]
SHORT = 1e-3  # of the body's extent: a bone that short has no direction to speak of
STUB = 0.05  # of the body's extent: length of a bone that has no way to go
LAST = 0.4  # of its parent's length: length of a bone whose tail was never captured
STRAIGHT = 0.5  # cosine of the angle up to which a bone goes on in a child


def build_armature(
    context: bpy.types.Context, name: str, skeleton: Skeleton, metres: float, mode: str
) -> tuple[bpy.types.Object, tuple[str, ...]]:
    """Add an armature to the scene, in its rest pose, selected and active.

    A bone goes from its joint to its child; among several to the one that goes straight on, as
    the neck does above the shoulders, or else to the middle of all. An end site is the tail of
    its bone rather than a bone. What `read_take` reads of the armature is the skeleton again.

    Parameters
    ----------
    context : bpy.types.Context
    name : of the object and the armature
    skeleton : Skeleton
    metres : float
        Length of one of the scene's units.
    mode : rotation mode of the bones

    Returns
    -------
    armature : bpy.types.Object
    bones : tuple of str, length n_joints
        Name of each joint's bone; empty where an end site is the tail of another bone.
    """
    in_object_mode(context)
    name = fitting_name(name)
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    add_object(context, armature)
    heads = skeleton.rest_positions / metres
    tips = _tips(skeleton)
    tails = _tails(skeleton, tips) / metres
    made = _add_bones(armature, skeleton, tips, heads, tails)
    for joint, bone in enumerate(made):
        if not bone:
            continue
        armature.pose.bones[bone].rotation_mode = mode
        if not skeleton.children[joint] and not skeleton.names[joint].endswith("_end"):
            armature.data.bones[bone][END] = True
    return armature, made


def _add_bones(
    armature: bpy.types.Object, skeleton: Skeleton, tips: set[int], heads: Array, tails: Array
) -> tuple[str, ...]:
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    made: dict[int, str] = {}
    for joint, parent in enumerate(skeleton.parents):
        if joint in tips:
            continue
        bone = bones.new(fitting_name(skeleton.names[joint]))
        bone.head, bone.tail = heads[joint], tails[joint]
        if parent >= 0:
            bone.parent = bones[made[parent]]
            bone.use_connect = bool((heads[joint] == tails[parent]).all())
        made[joint] = bone.name
    bpy.ops.object.mode_set(mode="OBJECT")
    return tuple(made.get(joint, "") for joint in range(skeleton.n_joints))


def _tips(skeleton: Skeleton) -> set[int]:
    """End sites that can be the tail of their parent's bone: its only child, some way off."""
    ways = np.linalg.norm(skeleton.offsets, axis=-1)
    return {
        joint
        for joint, parent in enumerate(skeleton.parents)
        if parent >= 0
        and skeleton.is_end_site(joint)
        and skeleton.names[joint] == f"{skeleton.names[parent]}_end"
        and len(skeleton.children[parent]) == 1
        and ways[joint] > SHORT * _extent(skeleton)
    }


def _tails(skeleton: Skeleton, tips: set[int]) -> Array:
    """Where the bone of each joint ends, shape (n_joints, 3), meters."""
    heads = skeleton.rest_positions
    extent = _extent(skeleton)
    tails = heads.copy()
    for joint, parent in enumerate(skeleton.parents):
        way = _way(skeleton, joint)
        if np.linalg.norm(way) <= SHORT * extent:
            above = tails[parent] - heads[parent] if parent >= 0 else np.array([0.0, 0.0, 1.0])
            length = np.linalg.norm(above)
            size = LAST * length if parent >= 0 else STUB * extent
            way = above / length * max(size, SHORT * extent)
        tails[joint] = heads[joint] + way
    return tails


def _way(skeleton: Skeleton, joint: int) -> Array:
    """From a joint to its child, to the one that goes straight on, or to the middle of all."""
    far = SHORT * _extent(skeleton)
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    children = [child for child in skeleton.children[joint] if lengths[child] > far]
    if not children:
        return np.zeros(3)
    ways = skeleton.offsets[children]
    if skeleton.parents[joint] < 0:  # the spine, since arms and head are above it
        return np.asarray(
            ways[int(np.argmax([len(skeleton.subtree(one)) for one in children]))]
        )
    cosines = ways @ skeleton.offsets[joint] / lengths[children] / max(lengths[joint], far)
    if len(children) == 1 or cosines.max() > STRAIGHT:
        return np.asarray(ways[int(np.argmax(cosines))])
    return np.asarray(ways.mean(axis=0))


def _extent(skeleton: Skeleton) -> float:
    """Return the longest side of the box around the rest pose; 1 m for a single joint."""
    return float(np.ptp(skeleton.rest_positions, axis=0).max()) or 1.0
