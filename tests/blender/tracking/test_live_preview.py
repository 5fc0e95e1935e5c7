"""Track in a window: the body is shown meanwhile, and Esc keeps tracked frames on request."""

import json

import numpy as np
import pytest
from modal_events import event, nothing_is_left, wait


@pytest.fixture
def press(load, press_button, points):
    """Press Track with these choices of looking on; return the button, which waits."""
    tracking, capture = (
        load("mocap_assist.track.tracking"),
        load("solvers.depth_tracking.capturing.capture"),
    )

    def press(watch=True, keep_on_esc=False):
        settings = tracking.TrackBundle(
            tracking.TrackChoices(plant_feet=False),
            capture.CaptureSettings(backward=False, refine=False),
            load("solvers.depth_scene.foreground").ForegroundSettings(),
            load("solvers.denoising").PlantSettings(),
            tracking.WatchChoices(watch=watch),
            tracking.EscChoices(keep_on_esc=keep_on_esc),
        )
        return press_button("track_depth", settings)

    return press


def drawn(button):
    return button._view and button._view.drawn  # there is no view while the job starts


def test_preview_body_is_at_the_points_and_the_frame_advances(press, window, blank, truth):
    blank.context.scene.frame_set(40, subframe=0.25)
    button = press()
    wait(button, window, until=lambda: drawn(button) is not None)
    drawing = button._view._drawing
    assert drawing.is_on

    frame = blank.context.scene.frame_current_final
    assert 1.0 <= frame <= 6.0
    observed = truth["joints"][int(frame) - 1]
    middle = np.array(blank.context.object.matrix_world)[:3] @ [*observed.mean(axis=0), 1.0]
    assert np.linalg.norm(drawn(button).points.mean(axis=0) - middle) < 0.2
    assert np.ptp(drawn(button).points[:, 2]) > 1.2
    assert drawn(button).triangles.max() == len(drawn(button).points) - 1

    assert wait(button, window) == {"FINISHED"}
    assert blank.context.scene.frame_current_final == 40.25
    assert not drawing.is_on and nothing_is_left(window)


def test_esc_discards_tracked_frames_by_default(press, window, blank):
    blank.context.scene.frame_set(9)
    button = press()
    wait(button, window, until=lambda: drawn(button) is not None)

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert window.reports == [({"INFO"}, "Cancelled.")]
    assert not blank.data.armatures and not blank.data.actions and nothing_is_left(window)
    assert blank.context.scene.frame_current == 9


def test_esc_keeps_tracked_frames_on_request(press, window, blank, truth, load):
    button = press(keep_on_esc=True)

    def three_poses():
        if not hasattr(button, "_job"):  # the take is still read
            return False
        previews, _ = load("mocap_assist.jobs.protocol").read_previews(button._job._path, 0)
        return sum(isinstance(each, tuple) and len(each) == 3 for each in previews) >= 3

    wait(button, window, until=three_poses)

    assert button.modal(window.context, event("ESC", "PRESS")) == {"FINISHED"}

    ((_, message),) = window.reports
    assert "Stopped early: " in message and "of 6 frames tracked" in message
    armature = blank.context.object
    action = armature.animation_data.action
    n_frames = int(message.split("Stopped early: ")[1].split()[0])
    assert 3 <= n_frames <= 6 and action.curve_frame_range[0] == 1.0
    assert action.curve_frame_range[1] == pytest.approx(n_frames, abs=1e-3)
    assert json.loads(action["mocap_assist_captured"])["operation"] == "track_depth"
    blank.context.scene.frame_set(2)
    head = armature.matrix_world @ armature.pose.bones["head"].head
    names = [str(each) for each in truth["joint_names"]]
    matrix = np.array(blank.data.objects["walk"].matrix_world)[:3]
    observed = matrix @ [*truth["joints"][1][names.index("Head")], 1.0]
    assert np.linalg.norm(np.array(head) - observed) < 0.15
    assert nothing_is_left(window)


def test_esc_before_the_first_pose_keeps_nothing_and_reports_it(press, window, blank):
    button = press(keep_on_esc=True)
    wait(button, window, until=lambda: hasattr(button, "_job"))

    assert button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert window.reports == [
        ({"ERROR"}, "No pose was tracked yet. Cancel later to keep a result.")
    ]
    assert not blank.data.armatures and nothing_is_left(window)


def test_points_deleted_during_tracking_are_named(press, window, blank, points):
    button = press()
    wait(button, window, until=lambda: drawn(button) is not None)
    blank.data.objects.remove(points)

    assert wait(button, window) == {"CANCELLED"}

    ((kind, message),) = window.reports
    assert kind == {"ERROR"} and "was deleted during the solve" in message
    assert nothing_is_left(window)


def test_nothing_is_drawn_without_live_preview(press, window, blank):
    blank.context.scene.frame_set(9)
    button = press(watch=False)
    assert button._view is None
    assert wait(button, window, until=lambda: blank.context.scene.frame_current != 9) == {
        "FINISHED"
    }


def test_loading_another_file_ends_tracking(press, window):
    button = press()
    wait(button, window, until=lambda: drawn(button) is not None)
    drawing = button._view._drawing

    button.cancel(window.context)

    assert not drawing.is_on and not button._watch.is_on
    assert nothing_is_left(window)


def test_previews_of_hours_take_little_space(load, tmp_path, monkeypatch):
    """Those that were shown are removed, and none is lost between two files."""
    protocol, job = load("mocap_assist.jobs.protocol"), load("mocap_assist.jobs.job")
    monkeypatch.setattr(protocol, "MAX_PREVIEWS_BYTES", 1000)
    show, reader = protocol.EndlessPreviews(tmp_path), object.__new__(job.Job)
    reader._path, reader._preview_offset, reader._preview_number = tmp_path, 0, 0
    found = []
    for number in range(1000):
        show((number, bytes(100)))
        if number % 7 == 0:
            found += reader.new_previews()
    show.close()
    for _ in range(5):
        found += reader.new_previews()

    assert [number for number, _ in found] == list(range(1000))
    assert len(list(tmp_path.iterdir())) == 1


def test_previews_without_room_are_left_out(load, tmp_path, monkeypatch):
    protocol = load("mocap_assist.jobs.protocol")
    show = protocol.EndlessPreviews(tmp_path)
    show("one")
    append, full = protocol.append_preview, OSError(28, "No space left on device")

    def fail(*_):
        raise full

    monkeypatch.setattr(protocol, "append_preview", fail)
    show("two")
    monkeypatch.setattr(protocol, "append_preview", append)
    show("three")

    assert protocol.read_previews(tmp_path, 0)[0] == ["one"]


def test_incomplete_pose_waits_for_the_next_read(load, tmp_path):
    protocol = load("mocap_assist.jobs.protocol")
    path = tmp_path / protocol.PREVIEWS
    with path.open("wb") as file:
        for thing in ("one", {"two": 2}):
            protocol.append_preview(file, thing)
    content = path.read_bytes()
    path.write_bytes(content[:-3])

    assert protocol.read_previews(tmp_path / "none", 0) == ([], 0)
    first, offset = protocol.read_previews(tmp_path, 0)
    assert first == ["one"]
    assert protocol.read_previews(tmp_path, offset) == ([], offset)
    path.write_bytes(content)
    assert protocol.read_previews(tmp_path, offset) == ([{"two": 2}], len(content))
