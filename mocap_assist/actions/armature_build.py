"""Make an armature whose bones are those of a skeleton."""

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import Skeleton
from ..blender import compat
from ..blender.data_names import fitting_name
from ..scene.rig import END
from ..scene.scene_objects import add_object, in_object_mode

MIN_BONE_FRACTION = 1e-3
"""Length of a bone, relative to the body's extent, below which it has no direction. It guards a
division."""
STUB_FRACTION = 0.05
"""Length of a bone without a direction, relative to the body's extent. Chosen by hand: 9 cm of
an adult."""
LAST_BONE_RATIO = 0.4
"""Length of a bone whose tail was never captured, relative to its parent's. Chosen by hand: 10
cm after a forearm."""
MIN_CONTINUATION_COSINE = 0.5
"""Cosine of the angle up to which a child continues its parent bone. Chosen by hand: 60
degrees."""


def build_armature(
    context: bpy.types.Context,
    name: str,
    skeleton: Skeleton,
    meters: float,
    mode: str,
    *,
    connected: bool = True,
) -> tuple[bpy.types.Object, tuple[str, ...]]:
    """Add an armature to the scene, in its rest pose, selected and active.

    It is drawn as sticks in front of all else: octahedra of long bones would hide the body.

    A bone goes from its joint to its child; among several to the one that goes straight on, as
    the neck does above the shoulders, or else to the middle of all. An end site is the tail of
    its bone rather than a bone. What `read_take` reads of the armature is the skeleton again.

    Parameters
    ----------
    context : bpy.types.Context
    name : of the object and the armature
    skeleton : Skeleton
    meters : float
        Length of one of the scene's units.
    mode : rotation mode of the bones
    connected : bool
        Whether a bone that begins at the tail of its parent ignores location keys.

    Returns
    -------
    armature : bpy.types.Object
    bones : tuple of str, length n_joints
        Name of each joint's bone; empty where an end site is the tail of another bone.
    """
    in_object_mode(context)
    name = fitting_name(name)
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    armature.data.display_type, armature.show_in_front = "STICK", True
    add_object(context, armature)
    heads = skeleton.rest_positions / meters
    tips = _tips(skeleton)
    tails = _tails(skeleton, tips) / meters
    bone_names = _add_bones(armature, skeleton, tips, heads, tails, connected)
    for joint, bone in enumerate(bone_names):
        if not bone:
            continue
        armature.pose.bones[bone].rotation_mode = mode
        if not skeleton.children[joint] and not skeleton.names[joint].endswith("_end"):
            armature.data.bones[bone][END] = True
    select_root(armature)
    return armature, bone_names


def select_root(armature: bpy.types.Object) -> None:
    """Select the root bone alone, so that the editors show keys of the take."""
    root = armature.data.bones[0]
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name == root.name)
    armature.data.bones.active = root


def _add_bones(
    armature: bpy.types.Object,
    skeleton: Skeleton,
    tips: set[int],
    heads: Array,
    tails: Array,
    connected: bool,
) -> tuple[str, ...]:
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    bone_names: dict[int, str] = {}
    for joint, parent in enumerate(skeleton.parents):
        if joint in tips:
            continue
        bone = bones.new(fitting_name(skeleton.names[joint]))
        bone.head, bone.tail = heads[joint], tails[joint]
        if parent >= 0:
            bone.parent = bones[bone_names[parent]]
            bone.use_connect = connected and bool((heads[joint] == tails[parent]).all())
        bone_names[joint] = bone.name
    bpy.ops.object.mode_set(mode="OBJECT")
    return tuple(bone_names.get(joint, "") for joint in range(skeleton.n_joints))


def _tips(skeleton: Skeleton) -> set[int]:
    """Return the end sites that can be tails: only children at a distance from their parent."""
    vectors = np.linalg.norm(skeleton.offsets, axis=-1)
    return {
        joint
        for joint, parent in enumerate(skeleton.parents)
        if parent >= 0
        and skeleton.is_end_site(joint)
        and skeleton.names[joint] == f"{skeleton.names[parent]}_end"
        and len(skeleton.children[parent]) == 1
        and vectors[joint] > MIN_BONE_FRACTION * skeleton.extent
    }


def _tails(skeleton: Skeleton, tips: set[int]) -> Array:
    """Return the tails of the bones of the joints, shape (n_joints, 3), meters."""
    heads = skeleton.rest_positions
    extent = skeleton.extent
    tails = heads.copy()
    for joint, parent in enumerate(skeleton.parents):
        vector = _bone_vector(skeleton, joint)
        if np.linalg.norm(vector) <= MIN_BONE_FRACTION * extent:
            above = tails[parent] - heads[parent] if parent >= 0 else np.array([0.0, 0.0, 1.0])
            length = np.linalg.norm(above)
            size = LAST_BONE_RATIO * length if parent >= 0 else STUB_FRACTION * extent
            vector = above / length * max(size, MIN_BONE_FRACTION * extent)
        tails[joint] = heads[joint] + vector
    return tails


def _bone_vector(skeleton: Skeleton, joint: int) -> Array:
    """Return the vector from a joint to its child, straightest child, or mean of all."""
    distant = MIN_BONE_FRACTION * skeleton.extent
    lengths = np.linalg.norm(skeleton.offsets, axis=-1)
    children = [child for child in skeleton.children[joint] if lengths[child] > distant]
    if not children:
        return np.zeros(3)
    vectors = skeleton.offsets[children]
    if skeleton.parents[joint] < 0:  # the spine, since arms and head are above it
        return np.asarray(
            vectors[int(np.argmax([len(skeleton.subtree(one)) for one in children]))]
        )
    cosines = (
        vectors @ skeleton.offsets[joint] / lengths[children] / max(lengths[joint], distant)
    )
    if len(children) == 1 or cosines.max() > MIN_CONTINUATION_COSINE:
        return np.asarray(vectors[int(np.argmax(cosines))])
    return np.asarray(vectors.mean(axis=0))
