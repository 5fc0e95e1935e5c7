"""A mesh of sticks: glTF has bones only where a mesh is skinned to them."""

import bpy
import numpy as np

BULGE_FRACTION = 0.15
"""Position along a bone where its stick is widest, as a fraction of the bone's length."""
RADIUS_FRACTION = 0.06
"""Half the width of a stick there, as a fraction of the bone's length."""
CORNERS = np.array([
    (0.0, 0.0, 0.0), (RADIUS_FRACTION, BULGE_FRACTION, 0.0),
    (0.0, BULGE_FRACTION, RADIUS_FRACTION), (-RADIUS_FRACTION, BULGE_FRACTION, 0.0),
    (0.0, BULGE_FRACTION, -RADIUS_FRACTION), (0.0, 1.0, 0.0),
])  # fmt: skip
FACES = ((0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1), (5, 2, 1), (5, 3, 2), (5, 4, 3), (5, 1, 4))


def add_stick_mesh(armature: bpy.types.Object) -> bpy.types.Object:
    """Add a mesh with a stick for each bone of an armature at the origin, skinned to it."""
    bones = list(armature.data.bones)
    points = []
    for bone in bones:
        matrix = np.array(bone.matrix_local, dtype=np.float64)
        points.append(bone.length * CORNERS @ matrix[:3, :3].T + matrix[:3, 3])
    faces = [
        tuple(len(CORNERS) * number + corner for corner in face)
        for number in range(len(bones))
        for face in FACES
    ]
    mesh = bpy.data.meshes.new(f"{armature.name} sticks")
    mesh.from_pydata(np.concatenate(points).tolist(), [], faces)
    made: bpy.types.Object = bpy.data.objects.new(mesh.name, mesh)
    bpy.context.scene.collection.objects.link(made)
    for number, bone in enumerate(bones):
        start = len(CORNERS) * number
        group = made.vertex_groups.new(name=bone.name)
        group.add(list(range(start, start + len(CORNERS))), 1.0, "REPLACE")
    made.parent = armature
    made.modifiers.new("Armature", "ARMATURE").object = armature
    return made
