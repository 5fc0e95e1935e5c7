"""Control rigs, skinned meshes, scenes in centimeters: what a file has, and its size."""

import json
import struct

import pytest
from armature_fixtures import BONES
from mathutils import Matrix
from numpy.testing import assert_allclose

MILLIMETER = 1e-3
CONTROLS = ("ORG-", "MCH-", "torso", "hand_fk")


@pytest.fixture
def content(export):
    """Export as GLB; return its JSON."""

    def read(**settings):
        data = export("out.glb", **settings).read_bytes()
        (length,) = struct.unpack("<I", data[12:16])
        return json.loads(data[20 : 20 + length])

    return read


@pytest.fixture
def skinned(walk, blank):
    """A triangle on the left foot of the walk, and one that nothing moves."""
    made = []
    for name in ("Skin", "Chair"):
        mesh = blank.data.meshes.new(name)
        mesh.from_pydata([(0.1, 0, 0.1), (0.2, 0, 0.1), (0.1, 0, 0.2)], [], [(0, 1, 2)])
        made.append(blank.data.objects.new(name, mesh))
        blank.context.scene.collection.objects.link(made[-1])
    made[0].vertex_groups.new(name="LeftFoot").add([0, 1, 2], 1.0, "REPLACE")
    made[0].modifiers.new("Armature", "ARMATURE").object = walk
    made[0].parent = walk
    return made[0]


@pytest.mark.parametrize("ending", ["fbx", "glb", "bvh"])
def test_sizes_are_true_in_a_scene_in_centimeters(walk, blank, export, bring, heads, ending):
    expected = heads(walk, range(1, 61), BONES)
    walk.data.transform(Matrix.Scale(100.0, 4))
    for curve in walk.animation_data.action.layers[0].strips[0].channelbags[0].fcurves:
        if curve.data_path.endswith("location"):
            for key in curve.keyframe_points:
                key.co.y *= 100.0
            curve.update()
    units = blank.context.scene.unit_settings
    units.scale_length = 0.01
    path = export(f"out.{ending}")
    units.scale_length = 1.0

    assert_allclose(heads(bring(path), range(1, 61), BONES), expected, atol=MILLIMETER)


def test_skinned_meshes_come_along_only_if_wanted(skinned, content):
    names = {each["name"] for each in content()["nodes"]}
    assert not names & {"Skin", "Chair"}

    found = content(meshes=True)

    names = {each["name"] for each in found["nodes"]}
    assert "Skin" in names and not any("Chair" in name or "stick" in name for name in names)
    assert [len(each["joints"]) for each in found["skins"]] == [len(BONES)]
    assert not any("scale" in each for each in found["nodes"] if each["name"] == "Actor")


def test_a_skinned_mesh_follows_in_fbx(skinned, walk, blank, export):
    scene, depsgraph = blank.context.scene, blank.context.evaluated_depsgraph_get

    def corners(mesh, frame):
        scene.frame_set(frame)
        shown = mesh.evaluated_get(depsgraph())
        return [tuple(shown.matrix_world @ each.co) for each in shown.data.vertices]

    expected = {frame: corners(skinned, frame) for frame in (1, 30, 60)}
    path = export("out.fbx", meshes=True)
    before = set(blank.data.objects)
    blank.ops.wm.fbx_import(filepath=str(path), anim_offset=0.0)

    (mesh,) = [each for each in set(blank.data.objects) - before if each.type == "MESH"]
    for frame, positions in expected.items():
        assert_allclose(corners(mesh, frame), positions, atol=MILLIMETER)


@pytest.fixture
def hero(blank, rigify_file, walker, give):
    """A Rigify rig that plays the walk."""
    with blank.data.libraries.load(str(rigify_file)) as (_, taken):
        taken.objects = ["Hero"]
    (rig,) = taken.objects
    blank.context.scene.collection.objects.link(rig)
    give(walker, rig)
    blank.context.view_layer.objects.active = rig
    return rig


@pytest.mark.parametrize("ending", ["fbx", "bvh"])  # GLB is written as FBX is
def test_of_a_rigify_rig_the_deforming_bones_are_exported(hero, export, bring, heads, ending):
    bones = ["DEF-spine", "DEF-forearm.L", "DEF-hand.R", "DEF-shin.L", "DEF-foot.R"]
    frames = range(1, 61, 10)
    expected = heads(hero, frames, bones)

    back = bring(export(f"out.{ending}"))

    names = {bone.name for bone in back.data.bones}
    assert not any(name.startswith(CONTROLS) for name in names)
    roots = [bone.name for bone in back.data.bones if bone.parent is None]
    assert len(roots) == 1, roots
    assert_allclose(heads(back, frames, bones), expected, atol=MILLIMETER)
