"""What is exported comes in again in true size, upright, at its rate, joint by joint."""

import pytest
from armature_fixtures import BONES
from mathutils import Matrix
from numpy.testing import assert_allclose

FORMATS = ("fbx", "glb", "bvh")
MILLIMETER = 1e-3


@pytest.mark.parametrize("ending", FORMATS)
@pytest.mark.parametrize("placed", ["plain", "scaled", "turned"])
def test_joints_come_back_within_a_millimeter(
    walk, blank, export, bring, heads, ending, placed
):
    if placed == "scaled":  # as Blender's importers leave takes in centimeters
        walk.data.transform(Matrix.Scale(100.0, 4))
        for bag in walk.animation_data.action.layers[0].strips[0].channelbags:
            for curve in bag.fcurves:
                if curve.data_path.endswith("location"):
                    for key in curve.keyframe_points:
                        key.co.y *= 100.0
                    curve.update()
        walk.scale = (0.01,) * 3
    if placed == "turned":
        walk.rotation_euler, walk.location = (0.0, 0.0, 1.0), (3.0, -2.0, 0.0)
    frames = range(1, 61)
    expected = heads(walk, frames, BONES)

    back = bring(export(f"out.{ending}"))

    assert back != walk
    scene = blank.context.scene
    assert_allclose(heads(back, frames, BONES), expected, atol=MILLIMETER)
    assert scene.render.fps / scene.render.fps_base == pytest.approx(30.0)
