"""Skinned meshes of a file are bound to the imported bones, and deform as in the file."""

import bpy
import numpy as np
import pytest

HEIGHT = 1.6


@pytest.fixture
def export(blank, tmp_path):
    """Write a file of an arm of three bones that bends, with a skinned tube around it."""

    def export(scale):
        rig = bpy.data.objects.new("arm", bpy.data.armatures.new("arm"))
        blank.context.scene.collection.objects.link(rig)
        blank.context.view_layer.objects.active = rig
        bpy.ops.object.mode_set(mode="EDIT")
        parent = None
        for number, name in enumerate(("upper", "lower", "hand", "finger")):
            bone = rig.data.edit_bones.new(name)
            bone.head, bone.tail = (0.4 * number, 0.1, 0.0), (0.4 * number + 0.4, 0.1, 0.0)
            bone.parent, parent = parent, bone
        bpy.ops.object.mode_set(mode="OBJECT")
        add_tube(rig)
        rig.scale = [scale] * 3
        rig.rotation_euler.z = 0.5
        rig.animation_data_create()
        for frame in range(1, 25):
            for number, bone in enumerate(rig.pose.bones):
                bone.rotation_mode = "XYZ"
                bone.rotation_euler.y = 0.03 * frame * number
                bone.keyframe_insert("rotation_euler", frame=frame)
        blank.context.scene.render.fps = 24
        path = tmp_path / "arm.fbx"
        bpy.ops.export_scene.fbx(filepath=str(path), add_leaf_bones=False)
        return path

    return export


def add_tube(rig):
    """Skin a row of rings, each vertex to the bone that it lies at."""
    along = np.linspace(0.05, HEIGHT - 0.05, 31)
    rings = [(x, 0.1 + y, z) for x in along for y, z in ((0.05, 0), (-0.05, 0), (0, 0.05))]
    faces = [(3 * ring, 3 * ring + 1, 3 * ring + 4, 3 * ring + 3) for ring in range(30)]
    mesh = bpy.data.meshes.new("tube")
    mesh.from_pydata(rings, [], faces)
    tube = bpy.data.objects.new("tube", mesh)
    bpy.context.scene.collection.objects.link(tube)
    for number, bone in enumerate(rig.data.bones):
        group = tube.vertex_groups.new(name=bone.name)
        group.add(
            [each for each in range(93) if int(rings[each][0] / 0.4) == number], 1.0, "ADD"
        )
    tube.parent = rig
    tube.modifiers.new("Armature", "ARMATURE").object = rig


def shown(context, frame):
    """World positions of the vertices of the only mesh, as deformed."""
    context.scene.frame_set(frame)
    (mesh,) = (each for each in context.scene.objects if each.type == "MESH")
    deformed = mesh.evaluated_get(context.evaluated_depsgraph_get())
    points = np.array([deformed.matrix_world @ each.co for each in deformed.data.vertices])
    return points[np.lexsort(np.round(points, 3).T)]


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_kept_meshes_deform_as_in_the_file(export, blank, scale, capfd):
    path = export(scale)
    expected = [shown(blank.context, frame) for frame in (1, 12, 24)]
    bpy.ops.wm.read_homefile(use_empty=True)
    blank.context.scene.render.fps = 24

    bpy.ops.mocap_assist.import_recording(
        filepath=str(path), keep_meshes=True, place_on_floor="NEVER"
    )

    assert "1 skinned mesh" in capfd.readouterr().out
    size = np.ptp(expected[0], axis=0).max()
    for frame, points in zip((1, 12, 24), expected, strict=True):
        found = shown(blank.context, frame)
        distances = np.linalg.norm(found[:, None] - points, axis=-1).min(axis=1)
        assert distances.max() < 2e-3 * size


def test_meshes_are_left_out_by_default_and_carry_no_materials(blank, recordings):
    path = recordings / "corpus/glb/khronos_cesiumman/CesiumMan.glb"

    bpy.ops.mocap_assist.import_recording(filepath=str(path))
    assert not bpy.data.meshes
    bpy.ops.mocap_assist.import_recording(filepath=str(path), keep_meshes=True)

    (mesh,) = (each for each in bpy.data.objects if each.type == "MESH")
    assert len(mesh.data.vertices) > 3000
    assert not bpy.data.materials and not bpy.data.images
    heights = shown(blank.context, 10)[:, 2]
    assert heights.min() == pytest.approx(0.0, abs=0.08)
    assert np.ptp(heights) == pytest.approx(1.5, abs=0.2)
