"""Make an armature without constraints that moves as another one is shown."""

from collections.abc import Sequence
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.arrays import Array
from ...solvers.progress import Progress
from ...solvers.rotations import matrix_from_quaternion, quaternion_from_matrix, unroll
from ..actions.bone_channels import bone_path
from ..actions.new_action import write_channels
from ..blender import compat
from ..rigs.rigify import is_rigify
from ..scene.rig import END, placement_of
from .file_formats import ExportedBones

MIN_LENGTH_M = 1e-3
"""Length of a bone, meters, at least. It guards against bones without a length, which
Blender deletes."""
SHIFT_TOLERANCE_M = 1e-5
"""Travel of a bone within its parent below which it has no location keys. It guards against
rounding of poses in single precision."""
SCALE_TOLERANCE = 1e-2
"""Relative change of a bone's size below which it is not reported. It guards against reports of
what no one sees: 5 mm of a thigh."""
DEFORMING, ORIGINAL = "DEF-", "ORG-"


@dataclass(frozen=True)
class BoneTree:
    """Bones to export, parents first, and the parent of each; -1 for none."""

    names: tuple[str, ...]
    parents: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class SampledPoses:
    """Sampled movement of bones, without their scale.

    Attributes
    ----------
    rotations : shape (n_frames, n_bones, 4), unit quaternions
        World rotation of each bone.
    positions : shape (n_frames, n_bones, 3)
        World position of each head, in units of the file.
    scales : bool
        Whether some bone changes its size, which is left out.
    """

    rotations: Array
    positions: Array
    scales: bool


def exported_tree(
    bones: Sequence[bpy.types.Bone], choice: ExportedBones, *, is_control_rig: bool
) -> BoneTree:
    """Return the bones to export; the parent of each is the nearest exported bone above it.

    Where no bone deforms, all are exported. Rigify hangs deforming bones on those that it
    calls ORG-, which stand for the deforming ones of the same name.
    """
    deforming = [bone for bone in bones if bone.use_deform]
    only_deforming = choice is ExportedBones.DEFORM or is_control_rig
    chosen = deforming if only_deforming and deforming else list(bones)
    index = {bone.name: number for number, bone in enumerate(chosen)}
    parents = []
    for bone in chosen:
        above = bone.parent
        while above is not None and _stand_in(above.name, index) in {"", bone.name}:
            above = above.parent
        parents.append(-1 if above is None else index[_stand_in(above.name, index)])
    order = _parents_first(parents)
    rank = {old: new for new, old in enumerate(order)} | {-1: -1}
    names = tuple(chosen[old].name for old in order)
    return BoneTree(names, tuple(rank[parents[old]] for old in order))


def _stand_in(name: str, index: dict[str, int]) -> str:
    """Return the exported bone that represents a bone; empty for none."""
    deforming = f"{DEFORMING}{name.removeprefix(ORIGINAL)}"
    return name if name in index else deforming if deforming in index else ""


def _parents_first(parents: Sequence[int]) -> list[int]:
    order: list[int] = []
    waiting = [bone for bone, parent in enumerate(parents) if parent < 0][::-1]
    while waiting:
        order.append(waiting.pop())
        waiting += [b for b, parent in enumerate(parents) if parent == order[-1]][::-1]
    return order


def build_plain_armature(
    armature: bpy.types.Object, tree: BoneTree, units: float
) -> bpy.types.Object:
    """Make an armature at the origin with the rest pose of another one in the world.

    Parameters
    ----------
    armature : bpy.types.Object
        It stands as at the first frame.
    tree : BoneTree
    units : float
        Units of the file for one of the scene.
    """
    bones = armature.data.bones
    rest, scale = _rigid(armature, [bones[name].matrix_local for name in tree.names], units)
    name, armature.name = armature.name, f"{armature.name} shown"
    made: bpy.types.Object = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(made)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.mode_set(mode="EDIT")
    for matrix, bone, parent in zip(rest, tree.names, tree.parents, strict=True):
        new = made.data.edit_bones.new(bone)
        length = max(bones[bone].length * scale * units, MIN_LENGTH_M)
        new.head, new.tail = (0.0, 0.0, 0.0), (0.0, length, 0.0)
        new.matrix = Matrix(matrix)
        new.parent = made.data.edit_bones[tree.names[parent]] if parent >= 0 else None
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone in tree.names:
        made.pose.bones[bone].rotation_mode = "QUATERNION"
        if bones[bone].get(END):
            made.data.bones[bone][END] = True
    return made


def _rigid(
    armature: bpy.types.Object, matrices: Sequence[Matrix], units: float
) -> tuple[Array, float]:
    """Return matrices of an armature's space in the world without scale, and that scale."""
    _, _, scale = placement_of(armature.matrix_world, armature.name)
    above = np.array(armature.matrix_world, dtype=np.float64)
    world: Array = above @ np.array(matrices, dtype=np.float64)
    world[:, :3, :3] /= scale
    world[:, :3, 3] *= units
    return world, scale


def sample_poses(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    frames: range,
    tree: BoneTree,
    units: float,
    progress: Progress,
) -> SampledPoses:
    """Return how bones are shown at each frame, constraints and drivers included."""
    order = [armature.pose.bones.find(name) for name in tree.names]
    shown = np.empty(16 * len(armature.pose.bones), np.float32)
    rotations = np.empty((len(frames), len(order), 4))
    positions = np.empty((len(frames), len(order), 3))
    scales = False
    for number, frame in enumerate(frames):
        scene.frame_set(frame)
        armature.pose.bones.foreach_get("matrix", shown)  # by columns
        poses = shown.reshape(-1, 4, 4).swapaxes(1, 2)[order].astype(np.float64)
        world = np.array(armature.matrix_world) @ poses
        sizes = np.linalg.norm(world[:, :3, :3], axis=1, keepdims=True)
        if number == 0:
            first = sizes
        scales = scales or bool((np.abs(sizes / first - 1.0) > SCALE_TOLERANCE).any())
        rotations[number] = quaternion_from_matrix(world[:, :3, :3] / sizes)
        positions[number] = units * world[:, :3, 3]
        progress(number / len(frames), "Sampling")
    return SampledPoses(unroll(rotations), positions, scales)


def animate_plain_armature(
    made: bpy.types.Object, tree: BoneTree, poses: SampledPoses, frames: range, name: str
) -> None:
    """Give a plain armature an action with keys on every frame."""
    rest = np.array([made.data.bones[bone].matrix_local for bone in tree.names])
    world = _matrices(poses)
    action, slot = compat.new_action(name, made)
    bag = compat.ensure_channelbag(action, slot)
    times = np.array(frames, dtype=np.float64)
    unit = bpy.context.scene.unit_settings.scale_length
    for index, (bone, parent) in enumerate(zip(tree.names, tree.parents, strict=True)):
        inside = np.linalg.inv(rest[index])
        carried = world[:, index]
        if parent >= 0:
            inside = inside @ rest[parent]
            carried = np.linalg.inv(world[:, parent]) @ carried
        basis = inside @ carried
        rotations = unroll(quaternion_from_matrix(basis[:, :3, :3])[:, None])[:, 0]
        write_channels(bag, bone_path(bone, "rotation_quaternion"), bone, times, rotations)
        shifts = basis[:, :3, 3]
        if parent < 0 or np.abs(shifts).max() * unit > SHIFT_TOLERANCE_M:
            write_channels(bag, bone_path(bone, "location"), bone, times, shifts)
    compat.assign(made, action, slot)


def _matrices(poses: SampledPoses) -> Array:
    world = np.zeros((*poses.positions.shape[:2], 4, 4))
    world[..., :3, :3] = matrix_from_quaternion(poses.rotations)
    world[..., :3, 3] = poses.positions
    world[..., 3, 3] = 1.0
    return world


def is_control_rig(armature: bpy.types.Object) -> bool:
    """Whether controls, not the bones that deform, carry the keys."""
    return is_rigify(armature.data.bones)
