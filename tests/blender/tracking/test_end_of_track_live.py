"""How Track Live ends: Esc, Stop, another file, the end of Blender, a full disk."""

import errno
import time
from contextlib import suppress
from pathlib import Path

import pytest
from modal_events import event, nothing_is_left, wait
from process_checks import children_of, descendants_of, wait_until_gone

pytestmark = pytest.mark.timeout(900)


@pytest.fixture
def n_frames():
    return 30


@pytest.fixture
def press(press_button, follow_bundle):
    return lambda **settings: press_button("track_live", follow_bundle(**settings))


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


def test_esc_just_after_the_recording_has_ended_does_not_discard(press, window, folder):
    """It was meant to end the take, which ended by itself: it is being written."""
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    assert button.heeds_esc()

    button._job.end_early()
    while not button._job.done():
        time.sleep(0.05)
    with suppress(Exception):
        button.result_from_job(button._job)

    assert not button.heeds_esc() and "Esc discards" in button._watch.ending
    button.cancel(window.context)


def test_full_disk_at_esc_ends_the_take(press, window, folder, load, monkeypatch):
    """Nothing is written for it, and a file that cannot be removed is tried again."""
    folder.mkdir()
    button = press()
    wait(button, window, until=lambda: hasattr(button, "_job"))
    job = load("mocap_assist.jobs.job")
    end_early, n_calls = job.Job.end_early, []

    def locked(self):
        n_calls.append(1)
        if len(n_calls) < 3:
            raise PermissionError("in use")
        end_early(self)

    monkeypatch.setattr(job.Job, "end_early", locked)
    monkeypatch.setattr(Path, "touch", full_disk)

    assert button.modal(window.context, event("ESC", "PRESS")) == {"RUNNING_MODAL"}

    assert wait(button, window) == {"CANCELLED"}
    ((kind, message),) = window.reports
    assert kind == {"INFO"} and message.startswith("No depth image came.") and len(n_calls) >= 3
    assert nothing_is_left(window)


def full_disk(*_, **__):
    raise OSError(errno.ENOSPC, "No space left on device")


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
