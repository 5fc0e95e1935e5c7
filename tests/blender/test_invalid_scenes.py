"""Invalid scenes: one sentence, at once, and nothing is changed."""

from types import SimpleNamespace

import numpy as np
import pytest
from modal_events import event, nothing_is_left, wait

BUTTONS = ("denoise", "measure_quality", "reduce_keys", "plant_feet", "simulate")


@pytest.fixture
def refused(blank):
    """Press a button; return the one sentence with which it refuses."""

    def press(button):
        actions = len(blank.data.actions)
        with pytest.raises(RuntimeError) as refusal:
            getattr(blank.ops.mocap_assist, button)()
        sentence = str(refusal.value).strip().removeprefix("Error: ")
        assert "Traceback" not in sentence and "\n" not in sentence, sentence
        assert len(blank.data.actions) == actions
        return sentence

    return press


def curves(armature):
    return armature.animation_data.action.layers[0].strips[0].channelbags[0].fcurves


@pytest.mark.parametrize("button", BUTTONS)
@pytest.mark.parametrize(
    ("scale", "reason"),
    [
        ((-1, 1, 1), "is mirrored by a negative scale"),
        ((-1, -1, -1), "is mirrored by a negative scale"),
        ((1, 1, -1), "is mirrored by a negative scale"),
        ((-2, 2, 2), "is mirrored by a negative scale"),
        ((0, 0, 0), "has scale 0"),
        ((1, 2, 1), "is scaled unevenly or sheared (1, 2, 1 along X, Y, Z)"),
    ],
)
def test_a_mirrored_armature_is_refused(actor, refused, blank, button, scale, reason):
    actor.scale = scale
    blank.context.view_layer.update()

    assert f"Actor {reason}. Give it one positive scale" in refused(button)


@pytest.mark.parametrize("button", BUTTONS)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_armature_with_nan_location_is_refused(actor, refused, blank, button, value):
    actor.location.x = value
    blank.context.view_layer.update()

    assert (
        "The location, rotation or scale of Actor is not a number or far too large"
        in refused(button)
    )


def test_a_bone_far_away_is_refused(actor, refused, blank):
    blank.ops.object.mode_set(mode="EDIT")
    for bone in actor.data.edit_bones:
        if not bone.children:
            bone.head, bone.tail = (1e30, 0, 0), (1e30, 1, 0)
    blank.ops.object.mode_set(mode="OBJECT")

    assert "in Actor is not a number or far too large. Move the bone" in refused("denoise")


@pytest.mark.parametrize("button", BUTTONS)
def test_key_at_frame_nan_is_refused(actor, refused, button):
    curves(actor)[0].keyframe_points[-1].co.x = np.nan

    assert "has a key whose frame is not a number (NaN)" in refused(button)


@pytest.mark.parametrize("button", BUTTONS)
@pytest.mark.parametrize("frame", [np.inf, -np.inf, 2e6])
def test_key_beyond_the_frame_limit_is_refused(actor, refused, button, frame):
    curves(actor)[0].keyframe_points[-1 if frame > 0 else 0].co.x = frame

    sentence = refused(button)

    assert "Blender plays no key beyond 1,048,574" in sentence
    assert len(sentence) < 150


@pytest.mark.parametrize("button", BUTTONS)
def test_keys_out_of_order_are_refused(actor, refused, button):
    """As `foreach_set` leaves them until the curve is updated."""
    for curve in curves(actor):
        keys = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
        curve.keyframe_points.foreach_get("co", keys)
        curve.keyframe_points.foreach_set("co", keys.reshape(-1, 2)[::-1].ravel())

    assert "has keys that are not in the order of their frames" in refused(button)


@pytest.mark.parametrize("button", BUTTONS)
@pytest.mark.parametrize("frame", [-1_000_000, 20_000, 1_048_574])
def test_distant_single_key_is_refused_before_sampling(
    actor, refused, load, monkeypatch, button, frame
):
    channel = load("mocap_assist.actions.curves").Channel
    monkeypatch.setattr(channel, "_evaluate_curve", lambda *_: pytest.fail("It was sampled."))
    curve = next(each for each in curves(actor) if "LeftArm" in each.data_path)
    curve.keyframe_points.insert(frame, 0.3)

    sentence = refused(button)

    assert "LeftArm" in sentence and f"{frame:,}" in sentence
    assert "choose a frame range" in sentence


def test_frame_range_excludes_a_distant_key(actor, blank):
    curves(actor)[0].keyframe_points.insert(500_000, 0.3)
    blank.context.scene.use_preview_range = True
    blank.context.scene.frame_preview_start, blank.context.scene.frame_preview_end = 1, 50

    outcome = blank.ops.mocap_assist.denoise(frame_range="PREVIEW", plant_feet=False)

    assert outcome == {"FINISHED"}
    assert curves(actor)[0].keyframe_points[-1].co.x == 500_000


def test_sparse_keys_are_read_at_any_distance(make_armature, animate, blank):
    armature = make_armature()
    animate(armature, frames=range(1, 9000, 1500))

    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}


@pytest.mark.parametrize("button", BUTTONS)
def test_extreme_frame_rate_is_refused(actor, refused, blank, button):
    blank.context.scene.render.fps, blank.context.scene.render.fps_base = 32767, 1e-5

    assert "Hz is not that of a recording" in refused(button)


@pytest.mark.parametrize("button", BUTTONS)
def test_take_of_nan_only_is_refused(actor, refused, button):
    for curve in curves(actor):
        keys = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
        curve.keyframe_points.foreach_get("co", keys)
        keys[1::2] = np.nan
        curve.keyframe_points.foreach_set("co", keys)

    assert "nothing was captured" in refused(button)


@pytest.fixture
def press_slowly(press_button, load, monkeypatch):
    """Press Clean in a window; Blender gets control after each bone that is read."""
    monkeypatch.setattr(load("mocap_assist.runtime.solver_operator"), "MAX_SLICE_S", 0.0)
    button_settings = load("mocap_assist.clean.button_settings")
    denoising = load("solvers.denoising")

    def press(**chosen):
        return press_button(
            "denoise",
            button_settings.CleanBundle(
                button_settings.CleanChoices(plant_feet=False, **chosen),
                denoising.DenoiseSettings(),
                denoising.PlantSettings(),
            ),
        )

    return press


def is_reading(button):
    return not hasattr(button, "_job")


def test_esc_cancels_reading_a_take(actor, press_slowly, window, blank):
    button = press_slowly()
    assert is_reading(button) and "Reading" in window.status[-1]
    button.modal(window.context, event("TIMER"))

    assert is_reading(button)
    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert nothing_is_left(window) and len(blank.data.actions) == 1


def test_take_read_in_time_slices_is_the_same(actor, press_slowly, window, blank, keys_of):
    played = actor.animation_data.action
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
    at_once = list(keys_of(actor.animation_data.action).values())
    actor.animation_data.action = played

    button = press_slowly()
    counter = SimpleNamespace(reading=0)

    def poll():
        counter.reading += is_reading(button)
        return False

    assert wait(button, window, poll) == {"FINISHED"}

    assert counter.reading > len(actor.data.bones)
    assert list(keys_of(actor.animation_data.action).values()) == at_once


def delete_armature(bpy, armature):
    bpy.data.objects.remove(armature)


def delete_action(bpy, armature):
    bpy.data.actions.remove(armature.animation_data.action)


def undo_like(bpy, armature):
    """Replace all curves, as undo does, which makes pointers to them stale."""
    before = armature.animation_data.action
    bag = before.layers[0].strips[0].channelbags[0]
    stored = [
        (curve.data_path, curve.array_index, [tuple(key.co) for key in curve.keyframe_points])
        for curve in bag.fcurves
    ]
    bag.fcurves.clear()
    for path, index, keys in stored:
        curve = bag.fcurves.new(path, index=index)
        for key in keys:
            curve.keyframe_points.insert(*key)


@pytest.mark.parametrize("change", [delete_armature, delete_action])
def test_object_deleted_during_reading_is_named(actor, press_slowly, window, blank, change):
    button = press_slowly()
    button.modal(window.context, event("TIMER"))
    assert is_reading(button)
    change(blank, actor)

    assert wait(button, window) == {"CANCELLED"}

    assert "was deleted during the solve" in window.reports[-1][1]
    assert nothing_is_left(window)


def test_curves_replaced_during_reading_are_found_again(
    actor, press_slowly, window, blank, keys_of
):
    played = actor.animation_data.action
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
    undisturbed = list(keys_of(actor.animation_data.action).values())
    actor.animation_data.action = played
    button = press_slowly()
    for _ in range(3):
        button.modal(window.context, event("TIMER"))
    assert is_reading(button)
    undo_like(blank, actor)

    assert wait(button, window) == {"FINISHED"}

    assert nothing_is_left(window)
    cleaned = actor.animation_data.action
    assert cleaned != played
    assert list(keys_of(cleaned).values()) == undisturbed
