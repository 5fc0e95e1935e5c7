"""Scenes of other units and rates."""

import json

import numpy as np
import pytest

FAST_SETTINGS = {"backward": False, "refine": False, "plant_feet": False}


@pytest.fixture
def n_frames():
    return 10


@pytest.fixture
def centimeters(truth, blank, tmp_path):
    """The points of a walk in a scene of centimeters and 24 frames per second."""
    path = tmp_path / "walk.npz"
    np.savez_compressed(path, **truth)
    scene = blank.context.scene
    scene.unit_settings.system, scene.unit_settings.scale_length = "METRIC", 0.01
    scene.render.fps = 24
    import_recording = blank.ops.mocap_assist.import_recording
    assert import_recording(filepath=str(path), frame_rate="SCALE") == {"FINISHED"}
    return blank.context.object


def test_body_and_retracking_work_in_centimeters_between_frames(
    centimeters, truth, blank, load
):
    assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}
    armature = blank.context.object
    blank.context.scene.frame_set(5)  # picture 5 is at frame 1 + 5 * 0.8
    drawn = load("mocap_assist.track.body_overlay").body_at(armature, 5)
    matrix = np.array(centimeters.matrix_world)
    observed = truth["joints"][5] @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.ptp(drawn.points[:, 2]) == pytest.approx(np.ptp(observed[:, 2]), rel=0.2)
    assert np.linalg.norm(drawn.points.mean(axis=0) - observed.mean(axis=0)) < 20.0

    before = armature.animation_data.action
    assert blank.ops.mocap_assist.retrack(reach=0.07) == {"FINISHED"}
    entry = json.loads(armature.animation_data.action["mocap_assist_history"])[-1]
    assert entry["picture"] == 5
    assert (entry["first_picture"], entry["last_picture"]) == (3, 7)
    compat = load("mocap_assist.blender.compat")
    slot = armature.animation_data.action_slot
    path = 'pose.bones["hips"].rotation_quaternion'
    times = [
        [
            key.co[0]
            for key in compat.channelbag(action, slot).fcurves.find(path).keyframe_points
        ]
        for action in (before, armature.animation_data.action)
    ]
    assert times[0] == pytest.approx(times[1], abs=1e-3)
