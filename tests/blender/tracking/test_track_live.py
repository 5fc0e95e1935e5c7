"""Track Live: what a recorder writes becomes points and an armature, as Track makes them."""

import json
import threading

import numpy as np
import pytest
from depth_folders import save_png
from modal_events import event, nothing_is_left, wait
from process_checks import children_of, descendants_of, wait_until_gone

RATE_HZ = 30.0
CAMERA = {"unit": "MILLIMETRES", "focal_length": 285.63}
FAST = {"calibration": 0.5, "max_silence": 1.0, "max_wait": 20.0, "max_delay": 0.0}
JOINTS = {"head": "Head", "leftUpperArm": "LeftArm", "rightLowerLeg": "RightLeg"}
pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def n_frames():
    return 30


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "take"


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
def bundle(load, folder):
    """Settings of the button, with those of `FollowSettings` that are given."""
    following, recordings = load("mocap_assist.track.following"), load("solvers.recordings")
    capture = load("solvers.depth_tracking.capturing.capture").CaptureSettings

    def make(**settings):
        unit = recordings.Unit.MILLIMETRES
        return following.FollowBundle(
            following.LiveChoices(
                recording_file=str(folder), unit=unit, focal_length=CAMERA["focal_length"]
            ),
            load("solvers.workflows.following").FollowSettings(**FAST | settings),
            load("mocap_assist.track.tracking").FeetChoices(),
            capture(refine=False),
            load("solvers.depth_scene.foreground").ForegroundSettings(),
            load("solvers.denoising").PlantSettings(),
        )

    return make


@pytest.fixture
def press(press_button, bundle):
    return lambda **settings: press_button("track_live", bundle(**settings))


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
    with pytest.raises(RuntimeError, match="Published methods track complete recordings"):
        track_live(method="EDGES")


def test_script_in_a_window_is_refused(track_live, load, monkeypatch):
    """It would block the window until the recording ends."""
    button = load("mocap_assist.track.follow_button")
    monkeypatch.setattr(button, "in_background", lambda: False)
    with pytest.raises(RuntimeError, match=r"INVOKE_DEFAULT, or use capture --follow\."):
        track_live()


@pytest.mark.parametrize(
    ("chosen", "recording"),
    [
        ("take", "take"),
        ("take/000001.png", "take"),
        ("take/depth/1.5.png", "take"),
        ("take/film.mkv", "take/film.mkv"),
    ],
)
def test_chosen_image_stands_for_its_folder(load, tmp_path, chosen, recording):
    found = load("mocap_assist.track.following").recording_of(tmp_path / chosen)

    assert found == tmp_path / recording


class TestWriting:
    """What is written of a motion that is given: nothing is solved."""

    @pytest.fixture
    def n_frames(self):
        return 20

    @pytest.fixture
    def followed(self, load, given_poses):
        def make(first=5, rate=30.0):
            body = load("solvers.depth_tracking.body.model").default_body()
            motion = load("solvers.depth_tracking.body.motion")
            tracked = load("mocap_assist.track.solve_tracking").Tracked(
                first=first,
                motion=motion.body_motion(body, given_poses, rate, None),
                body=body,
                floor=None,
                confidence={"hips": np.ones(20)},
                residual=np.full(20, 0.01),
                coverage=1.0,
                restarts=(),
                low_confidence=(),
                remarks=(),
            )
            camera = load("solvers.depth_scene").Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
            return load("mocap_assist.track.solve_following").Followed(tracked, camera, 3.0)

        return make

    @pytest.fixture
    def write(self, load, blank, bundle, followed):
        def write(settings=None, **options):
            scene = blank.context.scene
            return load("mocap_assist.track.following").write_followed(
                scene, scene, settings or bundle(), followed(**options)
            )

        return write

    @pytest.fixture
    def recorded(self, folder, truth):
        for number in range(30):
            save_png(folder / f"{number:06}.png", truth["depth"][number % 20])

    def test_points_and_motion_have_the_same_time(self, write, recorded, blank, load):
        """Image 5 is the first of the motion, which begins at frame 3."""
        write()

        shown = load("mocap_assist.depth.depth_preview").Shown.read(
            blank.data.objects["take"].data
        )
        assert shown.frame(5) == 3.0 and shown.step == 1.0
        action = blank.context.object.animation_data.action
        assert action.frame_range[:] == pytest.approx((3.0, 22.0))

    def test_scene_with_other_animation_keeps_its_time(self, write, recorded, blank):
        blank.ops.mesh.primitive_cube_add()
        blank.context.object.keyframe_insert("location", frame=1)

        write()

        scene = blank.context.scene
        assert (scene.render.fps, scene.frame_end) == (24, 250)
        last = 3.0 + 19 * 24.0 / 30.0
        action = blank.context.object.animation_data.action
        assert action.frame_range[1] == pytest.approx(last, abs=1e-3)

    def test_points_of_a_recording_at_another_rate_keep_their_own_time(
        self, write, recorded, blank, load
    ):
        write(rate=15.0)

        mesh = blank.data.objects["take"].data
        shown = load("mocap_assist.depth.depth_preview").Shown.read(mesh)
        assert shown.step == 0.5 and shown.frame(10) == 3.0
        action = blank.context.object.animation_data.action
        assert action.frame_range[:] == pytest.approx((3.0, 22.0))

    def test_recording_that_is_gone_has_an_armature_without_points(self, write, blank, load):
        message = write()

        assert "There is no file " in message
        points = blank.data.objects["take"]
        assert "take" in load("mocap_assist.depth.depth_preview").problem_of(points)
        assert blank.context.object.type == "ARMATURE"

    def test_images_of_several_sizes_have_an_armature_without_points(
        self, write, recorded, folder, truth, blank
    ):
        save_png(folder / "000030.png", truth["depth"][0, :100])

        message = write()

        assert "000030.png has 320 x 100 pixels, the others 320 x 240" in message
        assert blank.context.object.type == "ARMATURE"

    def test_earlier_images_of_the_same_folder_are_forgotten(
        self, write, recorded, folder, truth, blank, load
    ):
        preview = load("mocap_assist.depth.depth_preview")
        write()
        save_png(folder / "000030.png", truth["depth"][0])

        write()

        mesh = blank.data.objects["take.001"].data
        assert preview.recording_of(mesh).n_frames == 31

    def test_error_leaves_the_scene_as_it_was(self, write, recorded, blank, load, monkeypatch):
        following = load("mocap_assist.track.following")
        monkeypatch.setattr(following, "add_armature", lambda *_, **__: 1 / 0)

        with pytest.raises(ZeroDivisionError):
            write()

        scene = blank.context.scene
        assert not blank.data.objects and not blank.data.meshes
        assert (scene.render.fps, scene.frame_end) == (24, 250)


def test_panel_offers_the_button_once_a_folder_is_chosen(blank, draw):
    assert "Choose the folder that" in " ".join(draw("MOCAP_PT_tracklive"))
    blank.context.scene.mocap_assist.track_live.recording_file = "/tmp/take"

    drawn = draw("MOCAP_PT_tracklive")

    assert "mocap_assist.track_live" in drawn and "focal_length" in drawn
    assert "Choose the folder that" not in " ".join(drawn)


def test_settings_of_track_are_shared(load, blank):
    """Those of the panel Track Live and those of Track are copied, but none that is given."""
    scene = blank.context.scene
    scene.mocap_assist.track.refine = False
    scene.mocap_assist.track.plant_feet = False
    scene.mocap_assist.track_live.calibration = 4.0
    button = load("operators.track_live").MOCAP_OT_track_live
    given = {}

    class Pressed(button.__bases__[0]):
        setting_names = button.setting_names

        class properties:
            is_property_set = staticmethod("plant_feet".__eq__)

        def __setattr__(self, name, value):
            given[name] = value

    Pressed().prepare(blank.context)

    assert given["refine"] is False and given["calibration"] == 4.0
    assert "plant_feet" not in given and "method" in given
