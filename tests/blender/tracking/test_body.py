"""The body that was tracked stays with its armature, and follows whatever is done to that."""

import numpy as np
import pytest
from mathutils import Matrix, Quaternion


@pytest.fixture
def points(walk):
    return walk.points


@pytest.fixture
def tracked(walk, blank):
    blank.context.scene.frame_set(3)
    return walk.armature


@pytest.fixture
def body(load):
    overlay = load("mocap_assist.track.body_overlay")
    return lambda armature, frame=3: overlay.body_at(armature, frame)


def world_points(load, armature, points, frame):
    """Return the points that the camera saw, in the scene."""
    preview = load("mocap_assist.depth.depth_preview")
    recording = preview.recording_of(points.data)
    depth = recording.frame(frame)
    observed = recording.camera.back_project(depth)[depth > 0.0]
    matrix = np.array(points.matrix_world)
    return observed[::20] @ matrix[:3, :3].T + matrix[:3, 3]


def distances(observed, drawn):
    """Return how far points are from the nearest vertex that is drawn.

    A capsule has vertices at its ends only: the middle of a thigh is some 15 cm from any.
    """
    return np.sqrt(((observed[:, None] - drawn.points[None]) ** 2).sum(axis=-1).min(axis=1))


def test_capsules_match_the_points_and_have_confidence_colors(
    tracked, points, body, load, blank
):
    drawn = body(tracked)
    off = distances(world_points(load, tracked, points, 2), drawn)
    assert np.median(off) < 0.045 and np.quantile(off, 0.95) < 0.15
    assert len(np.unique(drawn.colors, axis=0)) > 3
    assert np.allclose(np.linalg.norm(drawn.normals, axis=-1), 1.0, atol=1e-4)
    assert body(points) is None and body(None) is None


def test_body_follows_a_posed_hand(tracked, body, blank):
    before = body(tracked).points.copy()
    bone = tracked.pose.bones["leftUpperArm"]
    bone.rotation_quaternion = Quaternion((0.0, 0.0, 1.0), 1.0) @ bone.rotation_quaternion
    blank.context.view_layer.update()
    moved = np.linalg.norm(body(tracked).points - before, axis=-1)
    assert moved.max() > 0.2
    assert (moved < 1e-5).mean() > 0.6


def test_body_survives_renaming_applied_transforms_and_saving(tracked, body, blank, tmp_path):
    before = body(tracked).points.copy()
    tracked.data.bones["leftUpperArm"].name = "upper_arm.L"
    transform = Matrix.Translation((0.3, 0.2, 0.1)) @ Matrix.Rotation(0.7, 4, "Z")
    transform = transform @ Matrix.Scale(1.5, 4)
    expected = before @ np.array(transform)[:3, :3].T + np.array(transform)[:3, 3]
    tracked.matrix_world = transform @ tracked.matrix_world
    blank.context.view_layer.update()
    np.testing.assert_allclose(body(tracked).points, expected, atol=1e-3)

    path = str(tmp_path / "tracked.blend")
    blank.ops.wm.save_as_mainfile(filepath=path)
    blank.ops.wm.open_mainfile(filepath=path)
    again = blank.data.objects["walk tracked"]
    np.testing.assert_allclose(body(again).points, expected, atol=1e-3)


def test_rotated_and_scaled_rest_pose_is_accepted(tracked, load, blank):
    module = load("mocap_assist.track.tracked_armature.body")
    model = module.TrackedBody.read(tracked).body
    transform = Matrix.Rotation(0.7, 4, "Z") @ Matrix.Scale(2.0, 4)
    tracked.data.transform(transform)

    matrix = module.armature_from_motion(tracked, model)

    np.testing.assert_allclose(matrix, transform, atol=1e-3)
    blank.ops.object.mode_set(mode="EDIT")
    tracked.data.edit_bones["leftLowerArm"].head.z += 0.2
    blank.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(load("solvers.errors").InvalidMotionError, match="rest pose"):
        module.armature_from_motion(tracked, model)


def test_damaged_body_is_not_drawn(tracked, body, load):
    module = load("mocap_assist.track.tracked_armature.body")
    tracked.data[module.KEY] = "{}"
    assert body(tracked) is None
    with pytest.raises(
        load("solvers.errors").InvalidMotionError, match="is not a tracked armature"
    ):
        module.TrackedBody.read(tracked)


def test_confidence_is_shown_for_tracked_armatures(tracked, load):
    colors = load("mocap_assist.overlays.confidence_colors")
    shown = colors.colored_bones_at(tracked, 3)
    assert shown is not None and len(shown.ends) == len(tracked.pose.bones)
    assert len(np.unique(shown.colors.reshape(-1, 4), axis=0)) > 3


def test_panel_shows_options_for_the_selection(points, tracked, blank, draw):
    assert {"mocap_assist.retrack", "mocap_assist_body", "reach"} <= set(draw("MOCAP_PT_track"))
    assert "mocap_assist.track_depth" not in draw("MOCAP_PT_track")
    manager, legend = blank.context.window_manager, {"Low", "Medium", "High"}
    manager.mocap_assist_body = not manager.mocap_assist_body
    is_drawn = legend <= set(draw("MOCAP_PT_track"))
    manager.mocap_assist_body = not manager.mocap_assist_body
    assert is_drawn != (legend <= set(draw("MOCAP_PT_track")))
    blank.context.view_layer.objects.active = points
    assert {"mocap_assist.track_depth", "watch", "keep_on_esc"} <= set(draw("MOCAP_PT_track"))
    assert "mocap_assist.retrack" not in draw("MOCAP_PT_track")
