"""Fix My Take on several takes: a list with the status of each, pause, and Esc."""

import tempfile
import time
from pathlib import Path

import pytest
from modal_events import event, nothing_is_left


def wait(button, window, until):
    """Let time pass until something has happened."""
    while not until():
        assert button.modal(window.context, event("TIMER")) == {"PASS_THROUGH"}
        time.sleep(0.005)


@pytest.fixture
def folder(load, tmp_path):
    """Two short walks and a damaged file."""
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    (tmp_path / "takes").mkdir()
    for name in ("a", "c"):
        recordings.write_bvh(walk, tmp_path / "takes" / f"{name}.bvh")
    (tmp_path / "takes" / "b.bvh").write_text("HIERARCHY\nROOT", encoding="utf-8")
    return tmp_path / "takes"


@pytest.fixture
def listed(load):
    """Name and status of each take in the list."""
    queue = load("mocap_assist.fix.queue")
    return lambda: [(each.name, each.status) for each in queue.shown_queue().takes]


@pytest.fixture
def queue_button(make_button, load, folder):
    """The button, given the folder by its file browser."""
    settings = load("mocap_assist.fix.button_settings").FixBundle
    button = make_button("fix_takes", settings(load("solvers.workflows").FixSettings()))
    button.directory = str(folder)
    return button


def test_folder_is_fixed_file_by_file(blank, folder, listed, draw):
    status = blank.ops.mocap_assist.fix_takes(directory=str(folder))

    assert status == {"FINISHED"}
    assert listed() == [("a.bvh", "DONE"), ("b.bvh", "FAILED"), ("c.bvh", "DONE")]
    played = {each.name: each.animation_data.action.name for each in blank.data.objects}
    assert played == {"a": "a.clean", "c": "c.clean"}
    assert all("mocap_assist_fix" in blank.data.actions[name] for name in played.values())
    assert "2 of 3 Fixed" in draw("MOCAP_PT_fix")


def test_selected_takes_are_fixed(blank, folder, listed, draw):
    for name in ("a", "c"):
        path = str(folder / f"{name}.bvh")
        assert blank.ops.mocap_assist.import_recording(filepath=path) == {"FINISHED"}
    assert "mocap_assist.fix_takes" not in draw("MOCAP_PT_fix")
    blank.data.objects["a"].select_set(True)
    assert "mocap_assist.fix_takes" in draw("MOCAP_PT_fix")

    assert blank.ops.mocap_assist.fix_takes(plant_feet=False) == {"FINISHED"}

    assert sorted(listed()) == [("a", "DONE"), ("c", "DONE")]


def test_each_fixed_take_is_an_undo_step_of_its_own(blank, folder, listed):
    window = blank.context.window_manager.windows[0]
    with blank.context.temp_override(window=window, screen=window.screen):
        blank.ops.ed.undo_push(message="empty")
        blank.ops.mocap_assist.fix_takes(directory=str(folder))

        blank.ops.ed.undo()
        assert set(blank.data.objects.keys()) == {"a"}
        assert blank.data.objects["a"].animation_data.action.name == "a.clean"
        blank.ops.ed.undo()  # the damaged file has no step: it has added nothing
        assert not blank.data.objects and "a.clean" not in blank.data.actions
        assert [status for _, status in listed()] == ["REMOVED", "FAILED", "REMOVED"]

        blank.ops.ed.redo()
        assert [status for _, status in listed()] == ["DONE", "FAILED", "REMOVED"]


def test_fix_folder_fixes_what_the_file_browser_chose(blank, folder, listed):
    (folder / "b.bvh").unlink()
    (folder / "c.bvh").unlink()

    assert blank.ops.mocap_assist.fix_folder(directory=str(folder)) == {"FINISHED"}

    assert listed() == [("a.bvh", "DONE")]
    assert blank.data.objects["a"].animation_data.action.name == "a.clean"


def test_fix_folder_reports_an_empty_folder(blank, tmp_path):
    with pytest.raises(RuntimeError, match="There is no recording in the folder") as raised:
        blank.ops.mocap_assist.fix_folder(directory=str(tmp_path))

    assert str(raised.value).count("Error") == 1


def test_loading_a_file_ends_the_queue(queue_button, window, listed, blank):
    assert queue_button.invoke(window.context, None) == {"RUNNING_MODAL"}
    wait(queue_button, window, until=lambda: "a" in blank.data.objects)

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert queue_button.modal(window.context, event("TIMER")) == {"CANCELLED"}
    assert not blank.data.objects and not list(Path(tempfile.gettempdir()).iterdir())
    assert all(status == "CANCELLED" for _, status in listed())


def test_nothing_selected_is_reported(blank):
    with pytest.raises(RuntimeError, match="Select animated armatures"):
        blank.ops.mocap_assist.fix_takes()


def test_pause_waits_between_two_takes_and_esc_keeps_what_is_done(
    queue_button, window, listed, blank, load
):
    queue = load("mocap_assist.fix.queue").shown_queue()
    assert queue_button.invoke(window.context, None) == {"RUNNING_MODAL"}
    assert queue_button.modal(window.context, event("A", "PRESS")) == {"RUNNING_MODAL"}
    queue.paused = True

    wait(queue_button, window, until=lambda: window.status[-1].startswith("Paused"))
    assert listed()[:2] == [("a.bvh", "DONE"), ("b.bvh", "WAITING")]
    assert queue_button.modal(window.context, event("A", "PRESS")) == {"PASS_THROUGH"}
    queue.paused = False
    wait(queue_button, window, until=lambda: listed()[2][1] == "RUNNING")
    wait(queue_button, window, until=lambda: "c" in blank.data.objects)
    assert queue_button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert listed() == [("a.bvh", "DONE"), ("b.bvh", "FAILED"), ("c.bvh", "CANCELLED")]
    assert list(blank.data.objects.keys()) == ["a"] and nothing_is_left(window)
    assert blank.data.objects["a"].animation_data.action.name == "a.clean"


def test_esc_during_a_pause_cancels_what_waits(queue_button, window, listed, folder, load):
    for name in ("a", "c"):
        (folder / f"{name}.bvh").write_text("HIERARCHY\nROOT", encoding="utf-8")
    assert queue_button.invoke(window.context, None) == {"RUNNING_MODAL"}
    load("mocap_assist.fix.queue").shown_queue().paused = True
    wait(queue_button, window, until=lambda: window.status[-1].startswith("Paused"))

    assert queue_button.modal(window.context, event("ESC", "PRESS")) == {"CANCELLED"}

    assert [status for _, status in listed()] == ["FAILED", "CANCELLED", "CANCELLED"]
    assert nothing_is_left(window)
