"""Take the skinned meshes out of the file that a background Blender has opened."""

from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import mathutils

from ...solvers.errors import InvalidFileError
from ..jobs.in_blender import SkinnedMeshes

MAX_BYTES = 1 << 28
"""Of the packed meshes of a file, bytes; guards memory against scans of whole scenes."""
FILE = "meshes.blend"


def pack_skinned_meshes() -> SkinnedMeshes | None:
    """Return the meshes of the open scene that armatures deform, in the rest pose, or None.

    Materials, other modifiers and animation are left out: they may name other files.

    Raises
    ------
    InvalidFileError
        The meshes are too large.
    """
    armatures = {each: each.find_armature() for each in bpy.data.objects if each.type == "MESH"}
    skinned = {mesh: armature for mesh, armature in armatures.items() if armature}
    if not skinned:
        return None
    owners = {mesh.name: armature.name for mesh, armature in skinned.items()}
    heads = {
        armature.name: {
            bone.name: tuple(armature.matrix_world @ bone.head_local)
            for bone in armature.data.bones
        }
        for armature in set(skinned.values())
    }
    for mesh in skinned:
        _reduce(mesh)
    with TemporaryDirectory() as folder:
        path = Path(folder) / FILE
        bpy.data.libraries.write(str(path), set(skinned), fake_user=True)
        if path.stat().st_size > MAX_BYTES:
            raise InvalidFileError(
                f"The meshes need more than {MAX_BYTES >> 20} MB. Import without Keep Meshes."
            )
        return SkinnedMeshes(path.read_bytes(), owners, heads)


def _reduce(mesh: bpy.types.Object) -> None:
    """Leave geometry in world space and weights only."""
    if mesh.data.users > 1:
        mesh.data = mesh.data.copy()
    world = mesh.matrix_world.copy()
    mesh.parent = None
    mesh.matrix_world = mathutils.Matrix.Identity(4)
    mesh.modifiers.clear()
    mesh.constraints.clear()
    for owner in filter(None, (mesh, mesh.data, mesh.data.shape_keys)):
        owner.animation_data_clear()
    mesh.data.materials.clear()
    mesh.data.transform(world, shape_keys=True)
    if world.is_negative:
        mesh.data.flip_normals()
