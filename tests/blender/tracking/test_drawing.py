"""The body is drawn whatever is done to its armature, and not where that is hidden."""

import numpy as np
import pytest


@pytest.fixture
def made(write_tracked, blank):
    made = write_tracked()
    blank.context.scene.frame_set(5)
    return made


@pytest.fixture
def drawn(made, load, blank):
    def drawn():
        blank.context.view_layer.update()
        return load("mocap_assist.scene.body_overlay").body_now(made.armature, 5.0)

    return drawn


@pytest.mark.parametrize("scale", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
def test_an_armature_that_is_scaled_to_nothing_is_no_error(scale, made, drawn):
    made.armature.scale = scale
    body = drawn()
    assert np.isfinite(body.points).all() and np.isfinite(body.normals).all()


def test_a_bone_that_is_scaled_to_nothing_is_no_error(made, drawn):
    made.armature.pose.bones["chest"].scale = (0.0, 0.0, 0.0)
    body = drawn()
    assert np.isfinite(body.points).all() and np.isfinite(body.normals).all()


@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (0.5, 1.0, 2.0), (-1.0, 1.0, 1.0)])
def test_normals_and_triangles_face_outwards(scale, made, drawn):
    """A closed surface whose triangles face outwards has a positive volume."""
    made.armature.scale = scale
    body = drawn()
    one, two, three = body.points[body.triangles].astype(np.float64).transpose(1, 0, 2)
    across = np.cross(two - one, three - one)
    assert (one * across).sum() > 0.0
    assert np.linalg.norm(body.normals, axis=-1) == pytest.approx(1.0, abs=1e-4)
    outwards = (across * body.normals[body.triangles].sum(axis=1)).sum(axis=-1)
    assert outwards.min() > -1e-9 and outwards.sum() > 0.0
