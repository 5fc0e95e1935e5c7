"""Track Live: what a recorder writes becomes points and an armature, as Track makes them."""

import json
import threading

import numpy as np
import pytest
from depth_folders import save_png
from followed_fixtures import CAMERA, FAST
from modal_events import event, nothing_is_left, wait
from process_checks import children_of, descendants_of, wait_until_gone

RATE_HZ = 30.0
JOINTS = {"head": "Head", "leftUpperArm": "LeftArm", "rightLowerLeg": "RightLeg"}
pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def n_frames():
    return 30


@pytest.fixture
def record(truth, folder):
    """Write the images of a walk at the rate of a camera, once or again and again."""
    threads, ended = [], threading.Event()

    def start(n_images=None):
        images = truth["depth"]
        n_images = len(images) if n_images is None else n_images

        def write():
            for number in range(n_images):
                save_png(folder / f"{number:06}.png", images[number % len(images)])
                if ended.wait(1.0 / RATE_HZ):
                    return

        threads.append(threading.Thread(target=write))
        threads[-1].start()

    yield start
    ended.set()
    for thread in threads:
        thread.join()


@pytest.fixture
def track_live(blank, folder):
    """Call the operator as a script of a background Blender does."""

    def call(path=folder, **settings):
        given = CAMERA | FAST | {"refine": False} | settings
        return blank.ops.mocap_assist.track_live(recording_file=str(path), **given)

    return call


@pytest.fixture
def press(press_button, follow_bundle):
    return lambda **settings: press_button("track_live", follow_bundle(**settings))


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


def test_esc_ends_the_take_and_keeps_it(record, press, window, blank):
    record(3000)
    button = press(max_silence=20.0)
    wait(button, window, until=lambda: "Tracking image" in window.status[-1])
    assert "Esc ends the take" in window.status[-1]
    wait(button, window, until=lambda: button._view.drawn is not None)
    assert button._view.points is not None and not blank.data.objects

    assert button.modal(window.context, event("ESC", "PRESS")) == {"RUNNING_MODAL"}

    assert wait(button, window) == {"FINISHED"}
    assert any("Finishing the take" in str(text) for text in window.status)
    assert any("Esc discards the take" in str(text) for text in window.status)
    ((kind, message),) = window.reports
    assert kind == {"INFO"} and message.startswith("take tracked: ")
    assert {each.type for each in blank.data.objects} == {"ARMATURE", "MESH"}
    assert nothing_is_left(window)


def test_esc_without_an_image_says_so_and_changes_nothing(press, window, blank, folder):
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    drawings = button._view._drawing, button._view._points_drawing

    button.modal(window.context, event("ESC", "PRESS"))

    assert wait(button, window) == {"CANCELLED"}
    ((kind, message),) = window.reports
    assert kind == {"INFO"} and message.startswith("No depth image came. Check the folder")
    assert not blank.data.objects and nothing_is_left(window)
    assert not any(each.is_on for each in drawings)


def test_esc_that_is_held_or_pressed_twice_does_not_discard(press, window, folder):
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    held = event("ESC", "PRESS")
    held.is_repeat = True

    button.modal(window.context, event("ESC", "PRESS"))
    button.modal(window.context, event("ESC", "PRESS"))
    button.modal(window.context, held)

    assert not button._job.cancelled
    wait(button, window)


def test_later_esc_discards(press, window, blank, load, folder, monkeypatch):
    monkeypatch.setattr(load("mocap_assist.track.follow_button"), "MIN_DISCARD_S", -1.0)
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))

    button.modal(window.context, event("ESC", "PRESS"))

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}
    assert window.reports == [({"INFO"}, "Cancelled.")]
    assert not blank.data.objects and nothing_is_left(window)


def test_stop_in_the_status_bar_is_one_esc(press, window, load, folder):
    """It does not count as another press of Esc in each event that follows."""
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    assert window.status[-1].endswith("[mocap_assist.cancel_solve]")

    load("mocap_assist.runtime.watch").cancel_running()
    wait(button, window)

    ((kind, message),) = window.reports
    assert kind == {"INFO"} and message.startswith("No depth image came.")


def test_both_processes_end_with_blender(press, window, folder):
    """The child notices that its input has closed, and the detector that the child is gone."""
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    child = button._job._child.process
    wait(button, window, until=lambda: len(children_of(child.pid)) > 1)
    processes = {child.pid, *descendants_of(child.pid)}

    child.stdin.close()

    assert not wait_until_gone(processes)
    assert wait(button, window) == {"CANCELLED"}
    assert nothing_is_left(window)


def test_loading_another_file_ends_both_processes(press, window, folder):
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    child = button._job._child.process.pid
    wait(button, window, until=lambda: len(children_of(child)) > 1)
    processes = {child, *descendants_of(child)}

    button.cancel(window.context)

    assert not wait_until_gone(processes) and nothing_is_left(window)


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
