"""Track: an armature over the points of a depth recording."""

import json

import numpy as np
import pytest

FAST_SETTINGS = {"backward": False, "refine": False, "plant_feet": False}
JOINTS = {
    "leftUpperArm": "LeftArm", "rightLowerArm": "RightForeArm", "head": "Head",
    "leftLowerLeg": "LeftLeg", "rightFoot": "RightFoot", "leftHand": "LeftHand",
}  # fmt: skip


def heads(armature, names):
    return np.array([armature.matrix_world @ armature.pose.bones[name].head for name in names])


def test_armature_is_at_the_points(points, truth, blank):
    matrix = np.array(points.matrix_world)
    assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}
    armature = blank.context.object
    assert armature.type == "ARMATURE" and armature.name == "walk tracked"

    names = [str(name) for name in truth["joint_names"]]
    for frame in (1, 6):
        blank.context.scene.frame_set(frame)
        observed = truth["joints"][frame - 1][[names.index(name) for name in JOINTS.values()]]
        world = observed @ matrix[:3, :3].T + matrix[:3, 3]
        off = np.linalg.norm(heads(armature, JOINTS) - world, axis=-1)
        assert off.mean() < 0.08


def test_armature_follows_moved_and_scaled_points(points, truth, blank, load):
    from mathutils import Matrix

    points.matrix_world = Matrix.Translation((3.0, 1.0, 0.5)) @ Matrix.Scale(2.0, 4)
    blank.context.view_layer.update()
    assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}

    blank.context.scene.frame_set(1)
    head = heads(blank.context.object, ["head"])[0]
    names = [str(name) for name in truth["joint_names"]]
    expected = 2.0 * truth["joints"][0][names.index("Head")] + (3.0, 1.0, 0.5)
    assert np.linalg.norm(head - expected) < 2.0 * 0.12


def test_residual_confidence_and_origin_are_stored_and_clean_accepts_them(points, blank, load):
    assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}
    armature = blank.context.object
    action = armature.animation_data.action
    report = json.loads(action["mocap_assist_captured"])
    assert report["operation"] == "track_depth" and report["recording"].endswith("walk.npz")
    assert 0.0 < report["mean_residual_cm"] < 5.0
    compat = load("mocap_assist.blender.compat")
    bag = compat.channelbag(action, armature.animation_data.action_slot)
    residual = bag.fcurves.find('["mocap_residual"]')
    keyed = [point.co[0] for point in residual.keyframe_points]
    assert keyed == pytest.approx([1, 2, 3, 4, 5, 6], abs=1e-3)
    assert 0.0 < armature["mocap_residual"] < 0.05
    paths = {curve.data_path for curve in bag.fcurves}
    assert 'pose.bones["leftLowerArm"]["mocap_reliability"]' in paths
    assert blank.context.scene.mocap_assist.checked_action == action
    assert points.name in blank.data.objects and len(blank.data.armatures) == 1

    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}  # raw to Clean
    assert armature.animation_data.action is not action


def test_button_gives_a_reason_without_points(blank):
    blank.ops.object.armature_add()
    assert not blank.ops.mocap_assist.track_depth.poll()
    with pytest.raises(RuntimeError, match="Select the points of an imported depth recording"):
        blank.ops.mocap_assist.track_depth()


def test_missing_recording_is_named_and_nothing_is_added(points, blank, load, tmp_path):
    (tmp_path / "walk.npz").unlink()
    preview = load("mocap_assist.depth.depth_preview")
    preview._loaded()
    before = set(blank.data.objects.keys())
    with pytest.raises(RuntimeError, match=r"walk\.npz"):
        blank.ops.mocap_assist.track_depth(**FAST_SETTINGS)
    assert set(blank.data.objects.keys()) == before


def test_track_reports_that_no_actor_was_detected(blank, tmp_path, truth):
    path = tmp_path / "empty.npz"
    np.savez_compressed(path, **{**truth, "depth": 0 * truth["depth"]})
    blank.ops.mocap_assist.import_recording(filepath=str(path))
    with pytest.raises(RuntimeError, match="No person is visible"):
        blank.ops.mocap_assist.track_depth(**FAST_SETTINGS)
    assert len(blank.data.armatures) == 0


@pytest.mark.parametrize("method", ["REGISTRATION", "EDGES"])
def test_published_methods_track_and_are_recorded(points, truth, blank, method):
    """The armature stands in the points, as that of the default."""
    matrix = np.array(points.matrix_world)
    settings = FAST_SETTINGS | {"method": method}

    assert blank.ops.mocap_assist.track_depth(**settings) == {"FINISHED"}

    armature = blank.context.object
    report = json.loads(armature.animation_data.action["mocap_assist_captured"])
    assert report["settings"]["method"] in {"wei", "lou"}
    names = [str(name) for name in truth["joint_names"]]
    blank.context.scene.frame_set(6)
    observed = truth["joints"][5][[names.index(name) for name in JOINTS.values()]]
    world = observed @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.linalg.norm(heads(armature, JOINTS) - world, axis=-1).mean() < 0.1


def test_method_is_a_research_setting_of_the_panel(points, blank, draw, request):
    track = blank.context.scene.mocap_assist.track
    assert "method" not in draw("MOCAP_PT_track")
    track.method = "EDGES"
    assert "method" in draw("MOCAP_PT_track")  # since it has an effect
    track.property_unset("method")
    request.getfixturevalue("show_research")
    assert draw("MOCAP_PT_track").count("method") == 1
