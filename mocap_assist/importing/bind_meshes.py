"""Bind skinned meshes of a file to the armature that Import has made."""

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import mathutils
import numpy as np

from ...solvers.arrays import Array
from ...solvers.rotations import fit_similarity
from ..blender.skinned_meshes import FILE
from ..jobs.in_blender import SkinnedMeshes
from ..scene.scene_objects import add_unselected

MAX_MISFIT = 0.02
"""Mean distance between bones of the file and of the scene (fraction of the body's extent) up
to which a mesh is bound. Measured: rounding gives 0.0001, another rest pose 0.1."""
MIN_BONES = 3
"""Bones that file and scene must share; fewer determine no rotation. By definition."""
UNFITTING = "without its meshes", "which do not fit the rest pose of these bones"


def bind_skinned_meshes(
    context: bpy.types.Context,
    meshes: SkinnedMeshes,
    owner: str,
    armature: bpy.types.Object,
) -> tuple[str, ...]:
    """Add the meshes of an armature of the file, bound to that of the scene; report how many.

    They are moved as the rest pose was: bones of one name lie on each other.
    """
    names = [mesh for mesh, each in meshes.owners.items() if each == owner]
    if not names:
        return ()
    placed = _placement(meshes.heads[owner], armature)
    if placed is None:
        return UNFITTING
    for mesh in _append(meshes.content, names):
        mesh.use_fake_user = mesh.data.use_fake_user = False
        mesh.data.transform(placed, shape_keys=True)
        add_unselected(context, mesh)
        mesh.parent = armature
        mesh.modifiers.new("Armature", "ARMATURE").object = armature
    return (_count(len(names)),)


def _count(n_meshes: int) -> str:
    return "1 skinned mesh" if n_meshes == 1 else f"{n_meshes} skinned meshes"


def _placement(
    heads: Mapping[str, tuple[float, ...]], armature: bpy.types.Object
) -> mathutils.Matrix | None:
    """Return the similarity from the file's world to the armature; None if bones differ."""
    bones = armature.data.bones
    common = [name for name in heads if name in bones]
    if len(common) < MIN_BONES:
        return None
    source: Array = np.array([heads[name] for name in common])
    target: Array = np.array([bones[name].head_local for name in common])
    rotation, scale, translation = fit_similarity(source, target)
    moved = scale * source @ rotation.T + translation
    extent = float(np.ptp(target, axis=0).max())
    if not np.linalg.norm(moved - target, axis=1).mean() <= MAX_MISFIT * extent:
        return None
    placed = np.eye(4)
    placed[:3, :3], placed[:3, 3] = scale * rotation, translation
    return mathutils.Matrix(placed)


def _append(content: bytes, names: list[str]) -> list[bpy.types.Object]:
    with TemporaryDirectory() as folder:
        path = Path(folder) / FILE
        path.write_bytes(content)
        with bpy.data.libraries.load(str(path), link=False) as (_, taken):
            taken.objects = names
    return [each for each in taken.objects if each is not None and each.type == "MESH"]
