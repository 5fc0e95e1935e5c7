"""The Graph Editor shows the recorded curve of each curve of a result, at the same height."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def raw_curves(load):
    return load("mocap_assist.drawing.raw_curves")


def curves_of(action):
    return action.layers[0].strips[0].channelbag(action.slots[0]).fcurves


@pytest.fixture
def shown(blank, actor, raw_curves):
    """Pairs of curves of a cleaned take, of which the editor shows some."""

    def pairs(visible):
        context = SimpleNamespace(
            visible_fcurves=visible,
            view_layer=blank.context.view_layer,
            selected_objects=[actor],
        )
        return raw_curves.shown_pairs(context)

    return pairs


def test_curves_of_a_result_have_those_of_the_recording_behind_them(blank, actor, shown):
    recorded = actor.animation_data.action
    assert shown(list(curves_of(recorded))) == []
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    played = actor.animation_data.action
    head = 'pose.bones["Head"].rotation_quaternion'
    visible = [curve for curve in curves_of(played) if curve.data_path == head]

    found = shown(visible)

    assert [each.played for each in found] == visible
    assert [each.recorded for each in found] == [
        curve for curve in curves_of(recorded) if curve.data_path == head
    ]
    assert shown(list(curves_of(recorded))) == []  # curves that the result does not have


def test_no_line_leads_over_a_gap(raw_curves, actor):
    curve = curves_of(actor.animation_data.action)[0]
    for key in reversed(curve.keyframe_points):
        if 20 <= round(key.co.x) < 30:
            curve.keyframe_points.remove(key)

    lines = raw_curves.curve_lines(curve)

    starts, ends = lines[:, 0, 0].tolist(), lines[:, 1, 0].tolist()
    assert starts == [*range(1, 19), *range(30, 60)]
    assert ends == [start + 1 for start in starts]
    assert_allclose(lines[0, :, 1], [key.co.y for key in list(curve.keyframe_points)[:2]])


def test_angles_are_shown_in_degrees_and_normalized_curves_from_minus_one(
    blank, raw_curves, make_armature, animate
):
    animate(make_armature(mode="XYZ"))
    curves = curves_of(blank.context.object.animation_data.action)
    angle = next(each for each in curves if each.data_path.endswith("rotation_euler"))
    values = np.array([key.co.y for key in angle.keyframe_points])
    scene = blank.context.scene

    factor, offset = raw_curves.displayed_values(angle, scene, normalized=False)
    assert (factor, offset) == (pytest.approx(180 / np.pi), 0)
    factor, offset = raw_curves.displayed_values(angle, scene, normalized=True)
    shown = values * factor + offset
    assert (shown.min(), shown.max()) == (pytest.approx(-1, abs=1e-5), pytest.approx(1))
