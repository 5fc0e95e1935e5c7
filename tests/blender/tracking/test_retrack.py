"""Track from Here: one frame is posed by hand, and the frames around it follow."""

import json

import numpy as np
import pytest
from mathutils import Quaternion
from modal_events import event, nothing_is_left, wait

ARM = "rightUpperArm"
AWAY = Quaternion((0.0, 1.0, 0.0), 1.2)


@pytest.fixture
def n_frames():
    return 16


@pytest.fixture
def points(walk):
    return walk.points


@pytest.fixture
def tracked(walk):
    return walk.armature


def hands(blank, armature, frames=range(1, 17)):
    positions = []
    for frame in frames:
        blank.context.scene.frame_set(frame)
        positions.append(armature.matrix_world @ armature.pose.bones["rightHand"].head)
    return np.array(positions)


def rotate_away(blank, armature, frames):
    """Key the arm wrongly in these frames."""
    bone = armature.pose.bones[ARM]
    for frame in frames:
        blank.context.scene.frame_set(frame)
        bone.rotation_quaternion = AWAY @ bone.rotation_quaternion
        bone.keyframe_insert("rotation_quaternion", frame=frame)


def keys(action, load, slot):
    bag = load("mocap_assist.blender.compat").channelbag(action, slot)
    return {
        (curve.data_path, curve.array_index): [tuple(key.co) for key in curve.keyframe_points]
        for curve in bag.fcurves
    }


def test_unkeyed_pose_corrects_the_frames_around_it(tracked, blank, load):
    right = hands(blank, tracked)
    wrong_frames = range(4, 13)
    rotate_away(blank, tracked, wrong_frames)
    wrong = hands(blank, tracked)
    raw, slot = tracked.animation_data.action, tracked.animation_data.action_slot
    before = keys(raw, load, slot)
    blank.context.scene.frame_set(8)
    bone = tracked.pose.bones[ARM]
    bone.rotation_quaternion = AWAY.inverted() @ bone.rotation_quaternion
    blank.context.view_layer.update()

    assert blank.ops.mocap_assist.retrack() == {"FINISHED"}

    action = tracked.animation_data.action
    assert action is not raw and action.name == raw.name + ".retracked"
    assert keys(raw, load, slot) == before
    corrected = hands(blank, tracked)
    off = np.linalg.norm(corrected - right, axis=-1)
    assert np.linalg.norm(wrong - right, axis=-1)[[4, 6, 9]].min() > 0.2
    assert off[7] < 0.01
    assert off[3:12].mean() < 0.05
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["operation"] == "retrack" and entry["picture"] == 7
    assert entry["first_picture"] <= 3 and entry["last_picture"] >= 11


def test_frames_beyond_its_reach_keep_their_keys(tracked, blank, load):
    raw, slot = tracked.animation_data.action, tracked.animation_data.action_slot
    before = keys(raw, load, slot)
    blank.context.scene.frame_set(8)

    assert blank.ops.mocap_assist.retrack(reach=0.1) == {"FINISHED"}

    action = tracked.animation_data.action
    after = keys(action, load, tracked.animation_data.action_slot)
    path = f'pose.bones["{ARM}"].rotation_quaternion'
    for index in range(4):
        assert after[path, index][:4] == before[path, index][:4]
        assert after[path, index][-4:] == before[path, index][-4:]
    assert len(after[path, 0]) == len(before[path, 0])
    entry = json.loads(action["mocap_assist_history"])[-1]
    assert (entry["first_picture"], entry["last_picture"]) == (4, 10)


def test_retracking_works_after_transforms_renaming_and_retracking(tracked, blank, load):
    from mathutils import Matrix

    tracked.matrix_world = Matrix.Translation((1.0, 2.0, 0.0)) @ Matrix.Scale(2.0, 4)
    tracked.data.bones["leftLowerLeg"].name = "shin.L"
    right = hands(blank, tracked)
    blank.context.scene.frame_set(5)
    assert blank.ops.mocap_assist.retrack(reach=0.1) == {"FINISHED"}
    blank.context.scene.frame_set(10)
    assert blank.ops.mocap_assist.retrack(reach=1.0) == {"FINISHED"}

    action = tracked.animation_data.action
    first, second = json.loads(action["mocap_assist_history"])
    assert (first["picture"], second["picture"]) == (4, 9)
    assert second["first_picture"] == 5  # the frame that was corrected first is fixed
    assert np.linalg.norm(hands(blank, tracked) - right, axis=-1).max() < 2.0 * 0.06
    revert = blank.ops.mocap_assist.revert_to_raw
    assert revert() == {"FINISHED"}
    assert "retracked" not in tracked.animation_data.action.name


def test_confidence_and_residual_are_updated_and_issues_are_listed(tracked, blank, load):
    blank.context.scene.frame_set(8)
    assert blank.ops.mocap_assist.retrack(reach=0.2) == {"FINISHED"}
    action, slot = tracked.animation_data.action, tracked.animation_data.action_slot
    bag = load("mocap_assist.blender.compat").channelbag(action, slot)
    residual = bag.fcurves.find('["mocap_residual"]')
    assert len(residual.keyframe_points) == 16
    assert all(0.0 < key.co[1] < 0.06 for key in residual.keyframe_points)
    assert bag.fcurves.find(f'pose.bones["{ARM}"]["mocap_reliability"]') is not None
    assert blank.context.scene.mocap_assist.checked_action == action


def test_retrack_gives_a_reason_when_refused(tracked, points, blank):
    blank.context.scene.frame_set(90)
    with pytest.raises(RuntimeError, match="Frame 90 is not in the recording"):
        blank.ops.mocap_assist.retrack()
    blank.context.view_layer.objects.active = points
    assert not blank.ops.mocap_assist.retrack.poll()
    with pytest.raises(RuntimeError, match="Select a tracked armature"):
        blank.ops.mocap_assist.retrack()


@pytest.fixture
def press(load, press_button, tracked):
    """Press Track from Here; return the button, which waits."""
    settings = load("solvers.depth_tracking").RetrackSettings()
    return lambda: press_button(
        "retrack", load("mocap_assist.track.retracking").RetrackBundle(settings)
    )


def test_retracking_has_a_preview_and_esc_restores_the_pose(
    tracked, press, window, blank, load
):
    action = tracked.animation_data.action
    blank.context.scene.frame_set(8)
    bone = tracked.pose.bones[ARM]
    bone.rotation_quaternion = AWAY @ bone.rotation_quaternion
    posed = bone.matrix_basis.copy()

    button = press()
    wait(button, window, until=lambda: button._view and button._view.drawn)
    drawn = button._view.drawn.points
    shown = blank.context.scene.frame_current  # on a busy machine not the first one
    body = load("mocap_assist.track.body_overlay").body_at(tracked, shown).points
    assert np.linalg.norm(drawn.mean(axis=0) - body.mean(axis=0)) < 0.1
    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert blank.context.scene.frame_current == 8
    np.testing.assert_allclose(bone.matrix_basis, posed, atol=1e-5)
    assert tracked.animation_data.action is action and nothing_is_left(window)

    assert wait(press(), window) == {"FINISHED"}
    ((_, cancelled), (_, message)) = window.reports
    assert cancelled == "Cancelled." and "from frame 8" in message
    np.testing.assert_allclose(bone.matrix_basis, posed, atol=1e-4)
