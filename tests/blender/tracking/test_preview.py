"""Whatever happens to the view of a solve, the solve goes on and its button ends."""

from functools import partial

import numpy as np
import pytest
from modal_events import event, nothing_is_left


class ShortJob:
    """Ends when it was looked at three times, and has found 7."""

    cancelled = False

    def __init__(self, solve):
        self.left = 3

    def new_previews(self):
        return []

    def done(self):
        self.left -= 1
        return self.left < 0

    def progress(self):
        return 0.5, "Counting"

    def result(self):
        return 7

    def cancel(self):
        pass

    def tidy_up(self):
        pass


class View:
    """Fails when it is looked at, or closed."""

    def __init__(self, looks=None, closes=None):
        self.looks, self.closes, self.n_looks, self.is_closed = looks, closes, 0, False

    def show(self, scene, target, previews):
        self.n_looks += 1
        if self.looks:
            raise self.looks

    def close(self):
        self.is_closed = True
        if self.closes:
            raise self.closes


@pytest.fixture
def press(load, window, blank, monkeypatch):
    """Press a button on which a view looks; return the button, which waits."""
    monkeypatch.setattr(load("mocap_assist.runtime.solver_operator"), "Job", ShortJob)
    blank.ops.object.armature_add()
    watched = load("mocap_assist.runtime.watched_operator").WatchedOperator

    class Button(watched):
        bl_idname, settings_group = "mocap_assist.count", "track"
        read_scene = staticmethod(lambda scene, thing, settings: partial(int, 7))
        write_scene = staticmethod(
            lambda scene, thing, settings, found, choices: f"{found} found."
        )

        def prepare(self, context):
            pass

        def settings(self):
            pass

        def report(self, kind, message):
            window.reports.append((kind, message))

    def press(view):
        Button.open_view = staticmethod(lambda *_: view)
        button = Button()
        assert button.invoke(window.context, None) == {"RUNNING_MODAL"}
        return button

    return press


def ended(button, window):
    """Let time pass, but not forever."""
    for _ in range(5):
        outcome = button.modal(window.context, event("TIMER"))
        if outcome != {"RUNNING_MODAL"}:
            return outcome
    return None


def test_failing_preview_is_closed_and_the_result_arrives(press, window):
    view = View(looks=np.linalg.LinAlgError("Singular matrix"))
    assert ended(press(view), window) == {"FINISHED"}
    assert (view.n_looks, view.is_closed) == (1, True)
    assert window.reports == [({"INFO"}, "7 found.")] and nothing_is_left(window)


def test_preview_of_a_deleted_object_waits(press, window, load):
    view = View(looks=load("solvers.errors").InvalidMotionError("Gone."))
    assert ended(press(view), window) == {"FINISHED"}
    assert view.n_looks > 1 and view.is_closed and nothing_is_left(window)


@pytest.mark.parametrize("looks", [None, ValueError("No.")])
def test_preview_that_cannot_be_closed_does_not_block_the_button(looks, press, window):
    view = View(looks=looks, closes=RuntimeError("Not now."))
    assert ended(press(view), window) == {"FINISHED"}
    assert view.is_closed and nothing_is_left(window)


def test_unreadable_files_count_as_no_progress(load, tmp_path, monkeypatch):
    """As where a virus scanner holds them."""
    protocol = load("mocap_assist.jobs.protocol")
    with (tmp_path / protocol.PREVIEWS).open("wb") as file:
        protocol.append_preview(file, "one")
    (tmp_path / protocol.LOG).write_text("@0.5 Half way\n")
    with monkeypatch.context() as held:
        held.setattr("pathlib.Path.open", lambda *_: (_ for _ in ()).throw(PermissionError()))
        assert protocol.read_previews(tmp_path, 0) == ([], 0)
        assert protocol.last_progress(tmp_path) == (0.0, "Starting")
    assert protocol.read_previews(tmp_path, 0)[0] == ["one"]
    assert protocol.last_progress(tmp_path) == (0.5, "Half way")


def test_track_from_here_has_a_preview_on_request(write_tracked, load, blank):
    made = write_tracked()
    retracking, choices = (
        load("mocap_assist.track.retracking"),
        load("mocap_assist.track.tracking"),
    )
    settings = load("solvers.depth_tracking").RetrackSettings()
    assert "watch" in blank.ops.mocap_assist.retrack.get_rna_type().properties
    blank.context.scene.mocap_assist.track.watch = False
    for wanted in (True, False):
        bundle = retracking.RetrackBundle(settings, choices.WatchChoices(watch=wanted))
        view = retracking.watch_retracking(blank.context.scene, made.armature, bundle)
        assert (view is not None) == wanted
        if view is not None:
            view.close()


def test_esc_discards_retracked_frames(load):
    retrack = load("operators.retrack").MOCAP_OT_retrack
    assert retrack.rescue(None, None, None) is None
