"""What is exported comes in again in true size, upright, at its rate, joint by joint."""

import addon_utils
import pytest
from armature_fixtures import BONES
from mathutils import Matrix
from numpy.testing import assert_allclose

FORMATS = ("fbx", "glb", "bvh")
MILLIMETER = 1e-3
FRAMES = range(1, 61)


@pytest.mark.parametrize("ending", FORMATS)
def test_joints_of_a_moved_take_come_back_within_a_millimeter(
    walk, blank, export, bring, heads, ending
):
    """The armature is scaled, as Blender's importers leave takes in centimeters, and turned."""
    walk.data.transform(Matrix.Scale(100.0, 4))
    for bag in walk.animation_data.action.layers[0].strips[0].channelbags:
        for curve in bag.fcurves:
            if curve.data_path.endswith("location"):
                for key in curve.keyframe_points:
                    key.co.y *= 100.0
                curve.update()
    walk.scale = (0.01,) * 3
    walk.rotation_euler, walk.location = (0.0, 0.0, 1.0), (3.0, -2.0, 0.0)
    expected = heads(walk, FRAMES, BONES)

    back = bring(export(f"out.{ending}"))

    assert back != walk
    assert_allclose(heads(back, FRAMES, BONES), expected, atol=MILLIMETER)


@pytest.mark.parametrize("ending", FORMATS)
def test_our_importer_and_those_of_blender_agree(walk, blank, export, bring, heads, ending):
    """Other programs have readers of their own; the take keeps its range and size there."""
    scene = blank.context.scene
    expected = heads(walk, FRAMES, BONES)
    path = export(f"out.{ending}")

    back = bring(path)

    assert_allclose(heads(back, FRAMES, BONES), expected, atol=MILLIMETER)
    assert scene.render.fps / scene.render.fps_base == pytest.approx(30.0)
    importers = {
        "fbx": lambda: blank.ops.wm.fbx_import(filepath=str(path)),
        "glb": lambda: blank.ops.import_scene.gltf(filepath=str(path)),
        "bvh": lambda: blank.ops.import_anim.bvh(
            filepath=str(path), global_scale=0.01, axis_forward="-Z", axis_up="Y"
        ),
    }
    before = set(blank.data.objects)
    if ending == "glb":
        addon_utils.enable("io_scene_gltf2")

    importers[ending]()

    theirs = next(each for each in set(blank.data.objects) - before if each.type == "ARMATURE")
    first, last = theirs.animation_data.action.frame_range
    assert last - first == pytest.approx(59.0, abs=1e-3)
    found = heads(theirs, [first + frame - 1 for frame in FRAMES], BONES)
    assert_allclose(found, expected, atol=MILLIMETER)
