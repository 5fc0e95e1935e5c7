"""What becomes of selection and modifiers where keys are replaced: Blender evaluates."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

FRAMES = np.arange(1.0, 61.0)
PART = np.arange(21.0, 41.0)


@pytest.fixture
def curve(make_armature, animate):
    """An F-Curve of 60 keys, none of them selected."""
    armature = make_armature(mode="XYZ")
    bag = animate(armature).layers[0].strips[0].channelbags[0]
    found = bag.fcurves.find('pose.bones["Head"].rotation_euler', index=0)
    for key in found.keyframe_points:
        select(key, False)
        key.interpolation = "LINEAR"
    return found


@pytest.fixture
def write(load):
    return load("mocap_assist.actions.curves").write_values


def select(key, selected):
    key.select_control_point = key.select_left_handle = key.select_right_handle = selected


def evaluated(curve, frames):
    return np.array([curve.evaluate(frame) for frame in frames])


def selected(curve):
    names = ("select_control_point", "select_left_handle", "select_right_handle")
    return np.array([[getattr(key, name) for name in names] for key in curve.keyframe_points])


@pytest.mark.parametrize("frames", [FRAMES, PART])
def test_new_keys_inherit_the_selection_of_replaced_keys(curve, write, frames):
    assert_array_equal(selected(curve), False)
    for index in (5, 25, 55):
        select(curve.keyframe_points[index], True)
    curve.keyframe_points[7].select_right_handle = True
    before = selected(curve)

    write(curve, frames, np.ones(len(frames)))

    assert_array_equal(selected(curve), before)


def test_added_keys_are_not_selected(curve, write):
    for key in list(curve.keyframe_points)[20:40][::-1]:
        curve.keyframe_points.remove(key)
    for key in curve.keyframe_points:
        select(key, True)

    write(curve, FRAMES, np.ones(60))

    assert selected(curve).all(axis=1).tolist() == [True] * 20 + [False] * 20 + [True] * 20


def noise(curve):
    modifier = curve.modifiers.new("NOISE")
    modifier.scale, modifier.strength, modifier.phase = 2.3, 0.4, 7.0


def limited_noise(curve):
    noise(curve)
    modifier = curve.modifiers[0]
    modifier.use_restricted_range = True
    modifier.frame_start, modifier.frame_end, modifier.blend_in = 10.0, 50.0, 3.0


def stepped(curve):
    curve.modifiers.new("STEPPED").frame_step = 4.0


def several(curve):
    """In this order: noise first, then the cut."""
    noise(curve)
    modifier = curve.modifiers.new("LIMITS")
    modifier.use_min_y, modifier.min_y = True, -0.1
    envelope = curve.modifiers.new("ENVELOPE")
    envelope.control_points.add(20.0)
    envelope.control_points.add(30.0)
    envelope.control_points.foreach_set("min", [-0.6, -0.5])
    envelope.control_points.foreach_set("max", [1.0, 2.0])
    generator = curve.modifiers.new("GENERATOR")
    generator.poly_order, generator.use_additive = 2, True
    generator.coefficients[0:3] = 0.1, 0.01, 0.001


@pytest.mark.parametrize("modify", [noise, limited_noise, stepped, several])
def test_modifiers_affect_only_keys_outside_the_range(curve, write, modify):
    modify(curve)
    before = evaluated(curve, FRAMES)
    assert np.abs(before - [key.co.y for key in curve.keyframe_points]).max() > 0.05

    write(curve, PART, before[20:40])

    assert_allclose(evaluated(curve, FRAMES), before, atol=1e-5)


@pytest.mark.parametrize(("written", "n_left"), [(FRAMES, 0), (PART, 2), (FRAMES[:20], 1)])
def test_modifier_is_removed_when_all_its_keys_are_written(curve, write, written, n_left):
    noise(curve)
    before = evaluated(curve, FRAMES)

    write(curve, written, evaluated(curve, written))

    assert_allclose(evaluated(curve, FRAMES), before, atol=1e-5)
    assert len(curve.modifiers) == n_left


def test_noise_modifier_fades_toward_the_written_keys(curve, write):
    noise(curve)
    write(curve, PART, np.zeros(20))

    between = np.array([20.0 + 1e-4, 21.0 - 1e-4, 40.0 + 1e-4, 41.0 - 1e-4])

    at_keys = evaluated(curve, [20.0, 21.0, 40.0, 41.0])
    assert_allclose(evaluated(curve, between), at_keys, atol=1e-3)


@pytest.mark.parametrize("frames", [FRAMES, PART])
def test_cycles_modifier_repeats_the_clean_keys(curve, write, frames):
    cycles = curve.modifiers.new("CYCLES")
    cycles.mode_after, cycles.cycles_after = "REPEAT_OFFSET", 3

    write(curve, frames, np.linspace(0.0, 1.0, len(frames)))

    (modifier,) = curve.modifiers
    assert (modifier.type, modifier.mode_after, modifier.cycles_after) == (
        "CYCLES",
        "REPEAT_OFFSET",
        3,
    )
    again, first = evaluated(curve, FRAMES + 59.0), evaluated(curve, FRAMES)
    assert_allclose(again, first + first[-1] - first[0], atol=1e-5)


def test_a_muted_modifier_stays_muted(curve, write):
    noise(curve)
    curve.modifiers[0].mute = True

    write(curve, PART, np.zeros(20))

    assert [(each.type, each.mute) for each in curve.modifiers] == [("NOISE", True)]
