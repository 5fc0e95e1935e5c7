"""The Graph Editor shows the recorded curve of each curve of a result, at the same height."""

from contextlib import nullcontext
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def raw_curves(load):
    return load("mocap_assist.overlays.comparison.raw_curves")


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


@pytest.fixture
def drawn(blank, load, monkeypatch):
    """Draw in a Graph Editor that shows all curves of an object; return the values drawn."""
    switch, blends = load("mocap_assist.overlays.comparison.raw_curves_switch"), []
    shader = SimpleNamespace(bind=lambda: None, uniform_float=lambda *_: None)
    lines = []

    def batch_of(_, __, content):
        heights = content["pos"][:, 1].tolist()
        return SimpleNamespace(draw=lambda _: lines.append(heights))

    monkeypatch.setattr("gpu_extras.batch.batch_for_shader", batch_of)
    gpu = SimpleNamespace(
        shader=SimpleNamespace(from_builtin=lambda _: shader),
        state=SimpleNamespace(viewport_get=lambda: (0, 0, 9, 9), blend_set=blends.append),
        matrix=SimpleNamespace(
            push_pop=nullcontext, translate=lambda _: None, scale=lambda _: None
        ),
    )
    monkeypatch.setattr(switch, "gpu", gpu)
    switch.forget()

    def draw(shown, normalized=False):
        lines.clear()
        animation = shown.animation_data
        bag = animation.action.layers[0].strips[0].channelbag(animation.action_slot)
        context = SimpleNamespace(
            space_data=SimpleNamespace(mode="FCURVES", use_normalization=normalized),
            visible_fcurves=list(bag.fcurves),
            view_layer=SimpleNamespace(objects=SimpleNamespace(active=shown)),
            selected_objects=[shown],
            scene=blank.context.scene,
            preferences=blank.context.preferences,
        )
        switch.draw_raw_curves(context)
        assert blends.pop() == "NONE"
        return list(lines)

    yield draw
    switch.forget()


def test_each_marker_of_an_action_has_its_own_recorded_curve(blank, drawn, load):
    history, compat = (
        load(f"mocap_assist.{name}") for name in ("scene.history", "blender.compat")
    )
    raw, result = (blank.data.actions.new(name) for name in ("Raw", "Clean"))
    markers = [blank.data.objects.new(name, None) for name in ("Head", "Hand")]
    for height, marker in enumerate(markers, start=1):
        for action in (raw, result):
            slot = action.slots.new("OBJECT", marker.name)
            curve = compat.ensure_channelbag(action, slot).fcurves.new("location", index=2)
            for frame in (1, 2):
                curve.keyframe_points.insert(frame, height)
        compat.assign(marker, result, slot)
    history.record(result, (raw, raw.slots[0]), {"operation": "test"})

    assert [drawn(marker) for marker in markers] == [[[1.0, 1.0]], [[2.0, 2.0]]]


@pytest.mark.parametrize("fault", ["order", "none"])
def test_keys_that_cannot_be_read_leave_the_other_curves(blank, actor, drawn, fault):
    blank.ops.mocap_assist.denoise()
    n_curves = len(drawn(actor, normalized=True))
    head = 'pose.bones["Head"].rotation_quaternion'
    points = curves_of(actor.animation_data.action).find(head, index=1).keyframe_points
    if fault == "order":
        points.foreach_set("co", np.tile([30.0, 0.0, 20.0, 0.0], len(points) // 2))
    else:
        points.clear()

    assert len(drawn(actor, normalized=True)) == n_curves - (fault == "order")
