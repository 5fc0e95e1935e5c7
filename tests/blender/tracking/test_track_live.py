"""Track Live: what a recorder writes becomes points and an armature, as Track makes them."""

import json
import threading
import time

import numpy as np
import pytest
from depth_folders import save_png
from followed_fixtures import CAMERA, FAST, RATE_HZ
from mkv_files import STRAIGHT, calibration, k4a

JOINTS = {"head": "Head", "leftUpperArm": "LeftArm", "rightLowerLeg": "RightLeg"}
pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def n_frames():
    return 30


@pytest.fixture
def track_live(blank, folder):
    """Call the operator as a script of a background Blender does."""

    def call(path=folder, **settings):
        given = CAMERA | FAST | {"refine": False} | settings
        return blank.ops.mocap_assist.track_live(recording_file=str(path), **given)

    return call


def heads(armature, names):
    return np.array([armature.matrix_world @ armature.pose.bones[name].head for name in names])


def test_followed_recording_becomes_what_track_makes(record, track_live, blank, truth, load):
    blank.context.scene.frame_set(7)
    record()

    assert track_live() == {"FINISHED"}

    armature, points = blank.context.object, blank.data.objects["take"]
    assert armature.name == "take tracked" and points.type == "MESH"
    action, scene = armature.animation_data.action, blank.context.scene
    assert action.frame_range[:] == pytest.approx((7.0, 36.0))
    assert (scene.render.fps, scene.frame_start, scene.frame_end) == (30, 7, 36)
    names = [str(name) for name in truth["joint_names"]]
    matrix = np.array(points.matrix_world)
    for image in (20, 29):
        scene.frame_set(7 + image)
        true = truth["joints"][image][[names.index(name) for name in JOINTS.values()]]
        world = true @ matrix[:3, :3].T + matrix[:3, 3]
        assert np.linalg.norm(heads(armature, JOINTS) - world, axis=-1).mean() < 0.1
    preview = load("mocap_assist.depth.depth_preview")
    assert not preview.problem_of(points) and preview.recording_of(points.data).n_frames == 30
    stored = json.loads(action["mocap_assist_captured"])
    assert stored["operation"] == "track_live" and stored["recording"].endswith("take")
    compat = load("mocap_assist.blender.compat")
    paths = {
        curve.data_path
        for curve in compat.channelbag(action, armature.animation_data.action_slot).fcurves
    }
    assert 'pose.bones["leftLowerArm"]["mocap_reliability"]' in paths
    assert '["mocap_residual"]' in paths
    assert blank.context.scene.mocap_assist.checked_action == action
    assert not load("mocap_assist.track.retracking").why_not_retrack(blank.context)


def test_mkv_is_followed_while_it_grows(track_live, truth, tmp_path, blank, load):
    content = k4a(truth["depth"], calibration(STRAIGHT), open_sizes=True)
    path = tmp_path / "film.mkv"
    step = len(content) // 30

    def write():
        with path.open("wb") as file:
            for start in range(0, len(content), step):
                file.write(content[start : start + step])
                file.flush()
                time.sleep(1.0 / RATE_HZ)

    recorder = threading.Thread(target=write)
    recorder.start()

    assert track_live(path, focal_length_y=285.63, center_x=159.5, center_y=119.5) == {
        "FINISHED"
    }

    recorder.join()
    armature, points = blank.context.object, blank.data.objects["film"]
    assert armature.animation_data.action.frame_range[1] > 20.0
    preview = load("mocap_assist.depth.depth_preview")
    assert not preview.problem_of(points) and preview.recording_of(points.data).n_frames == 30


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda folder: None, "No depth image came. Check the folder .*take that the recorder"),
        (lambda folder: folder.rmdir(), "No depth image came. Check the folder .*take"),
        (
            lambda folder: (folder.rmdir(), folder.write_text("x")),
            "cannot be read while",
        ),
        (
            lambda folder: save_png(folder / "0.png", np.zeros((9, 8), np.uint8)),
            "0.png is a gray image of 8 bits; depth is gray and has 16",
        ),
        (
            lambda folder: [
                save_png(folder / f"{number}.png", np.zeros((120, 160), np.uint16))
                for number in range(20)
            ],
            "No person is visible",
        ),
    ],
)
def test_nothing_to_track_is_one_sentence(track_live, folder, blank, change, sentence):
    folder.mkdir()
    change(folder)

    with pytest.raises(RuntimeError, match=sentence):
        track_live(max_wait=0.5)

    assert not blank.data.objects and blank.context.scene.frame_end == 250


def test_camera_that_is_unknown_is_one_sentence(track_live, folder):
    save_png(folder / "0.png", np.zeros((9, 8), np.uint16))

    with pytest.raises(RuntimeError, match="set the camera's focal lengths"):
        track_live(focal_length=0.0)


def test_folder_must_be_chosen(track_live):
    with pytest.raises(RuntimeError, match="Choose the folder that the recorder writes to"):
        track_live("")


def test_published_methods_are_refused(track_live):
    with pytest.raises(RuntimeError, match="tracks one person in the complete recording"):
        track_live(method="EDGES")


def test_script_in_a_window_is_refused(track_live, load, monkeypatch):
    """It would block the window until the recording ends."""
    button = load("mocap_assist.track.follow_button")
    monkeypatch.setattr(button, "in_background", lambda: False)
    with pytest.raises(RuntimeError, match=r"INVOKE_DEFAULT, or use capture --follow\."):
        track_live()
