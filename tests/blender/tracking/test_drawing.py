"""The body is drawn whatever is done to its armature, and not where that is hidden."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def drawn(made, load, blank):
    def drawn():
        blank.context.view_layer.update()
        return load("mocap_assist.track.body_overlay").body_at(made.armature, 5.0)

    return drawn


@pytest.mark.parametrize("scale", [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])
def test_armature_of_scale_zero_is_no_error(scale, made, drawn):
    made.armature.scale = scale
    body = drawn()
    assert np.isfinite(body.points).all() and np.isfinite(body.normals).all()


def test_bone_of_scale_zero_is_no_error(made, drawn):
    made.armature.pose.bones["chest"].scale = (0.0, 0.0, 0.0)
    body = drawn()
    assert np.isfinite(body.points).all() and np.isfinite(body.normals).all()


@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (0.5, 1.0, 2.0), (-1.0, 1.0, 1.0)])
def test_normals_and_triangles_face_outward(scale, made, drawn):
    """A closed surface whose triangles face outwards has a positive volume."""
    made.armature.scale = scale
    body = drawn()
    one, two, three = body.points[body.triangles].astype(np.float64).transpose(1, 0, 2)
    across = np.cross(two - one, three - one)
    assert (one * across).sum() > 0.0
    assert np.linalg.norm(body.normals, axis=-1) == pytest.approx(1.0, abs=1e-4)
    outwards = (across * body.normals[body.triangles].sum(axis=1)).sum(axis=-1)
    assert outwards.min() > -1e-9 and outwards.sum() > 0.0


@pytest.mark.parametrize("how", ["hidden", "no armatures", "excluded"])
def test_the_body_of_a_hidden_armature_is_not_drawn(how, made, load, blank, monkeypatch):
    wanted = load("mocap_assist.track.body_overlay").body_to_draw
    areas = blank.context.window_manager.windows[0].screen.areas
    (area, *_) = (each for each in areas if each.type == "VIEW_3D")
    context = SimpleNamespace(
        window_manager=blank.context.window_manager,
        view_layer=blank.context.view_layer,
        scene=blank.context.scene,
        space_data=area.spaces.active,
    )
    monkeypatch.setattr(blank.context.window_manager, "mocap_assist_body", True)
    assert wanted(context) is not None
    if how == "hidden":
        made.armature.hide_set(True)
    elif how == "no armatures":
        monkeypatch.setattr(area.spaces.active, "show_object_viewport_armature", False)
    else:
        made.armature.hide_viewport = True
    blank.context.view_layer.update()
    assert wanted(context) is None
