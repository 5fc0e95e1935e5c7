"""Fix My Take on depth images: one press from the points to a clean, tracked armature."""

import json

import pytest


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


def test_command_finds_points(points, load):
    command = load("mocap_assist.batch.command")

    assert command._subjects(None, "", load("mocap_assist.batch.verbs").VERBS["fix"]) == [
        points
    ]
