"""Fix My Take on depth images: one press from the points to a clean, tracked armature."""

import json

import pytest
from modal_events import event, nothing_is_left, wait


@pytest.fixture
def n_frames():
    return 3


def test_depth_images_become_a_clean_armature(points, blank, draw):
    assert "mocap_assist.fix_take" in draw("MOCAP_PT_fix")

    assert blank.ops.mocap_assist.fix_take() == {"FINISHED"}

    armature = blank.context.object
    action = armature.animation_data.action
    assert armature.name == "walk tracked" and action.name == "walk tracked.clean"
    card = json.loads(action["mocap_assist_fix"])
    assert card["origin"] == "depth images" and "Track found the actor" in card["steps"][0]
    assert card["headline"] and card["headline"] in " ".join(draw("MOCAP_PT_fix"))
    frames = armature.animation_data.action.frame_range
    assert tuple(frames) == (1.0, 3.0)

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert armature.animation_data.action.name == "walk tracked"
    assert "mocap_assist_captured" in armature.animation_data.action


def test_body_is_shown_during_tracking(points, press_button, load, window, blank):
    blank.context.scene.frame_set(9)
    settings = load("mocap_assist.fix.button_settings").FixBundle
    button = press_button("fix_take", settings(load("solvers.workflows").FixSettings()))
    wait(button, window, until=lambda: button._view and button._view.drawn is not None)
    drawing = button._view._drawing
    assert drawing.is_on and 1 <= blank.context.scene.frame_current <= 3

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert not drawing.is_on and blank.context.scene.frame_current == 9
    assert not blank.data.armatures and nothing_is_left(window)


def test_no_body_is_shown_without_live_preview(points, load, blank):
    fixing = load("mocap_assist.fix.scene_fixing")
    blank.context.scene.mocap_assist.track.watch = False

    assert fixing.watch_fixing(blank.context.scene, points, None) is None


def test_command_finds_points(points, load):
    command = load("mocap_assist.batch.command")

    assert command._subjects(None, "", load("mocap_assist.batch.verbs").VERBS["fix"]) == [
        points
    ]
