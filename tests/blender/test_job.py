"""A solve in a process of its own: same answer, prompt end, no trace."""

import os
import signal
import tempfile
import time
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def job(load):
    return load("mocap_assist.jobs.job").Job


@pytest.fixture
def problem(load, rng):
    """A leg that shakes, of so many frames."""
    motion = load("solvers.motion")
    turns = load("solvers.motion.rotations")
    skeleton = motion.Skeleton(("hip", "knee"), (-1, 0), np.array([[0, 0, 0.9], [0, 0, -0.4]]))

    def make(n_frames):
        vectors = rng.normal(scale=0.1, size=(n_frames, 2, 3))
        rotations = turns.quaternion_from_rotation_vector(vectors)
        return motion.Motion(skeleton, rotations, np.zeros((n_frames, 3)), 30.0)

    return make


@pytest.fixture(autouse=True)
def own_temporary_folder(tmp_path, monkeypatch):
    """Others that solve on this machine at the same time leave their folders elsewhere."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def folders():
    return set(Path(tempfile.gettempdir()).glob("mocap_assist_*"))


def test_the_answer_is_that_of_this_process(job, load, problem):
    solve = partial(load("solvers.denoising").denoise, problem(60))

    found = job(solve).result().recording

    np.testing.assert_allclose(found.rotations, solve().recording.rotations, atol=1e-9)


def test_cancelling_ends_it_at_once_and_leaves_nothing(job, load, problem):
    before = folders()
    running = job(partial(load("solvers.denoising").denoise, problem(20_000)))
    while running.progress() == (0.0, "Starting") and not running.done():
        time.sleep(0.05)

    running.cancel()

    with pytest.raises(load("solvers.errors").SolveCancelled):
        running.result()
    assert running.done()
    assert folders() == before


def test_what_the_solver_raises_is_raised_here_with_its_traceback(job, load, problem):
    motion = problem(10)
    contacts = np.zeros((3, 2), bool)
    solve = partial(load("solvers.denoising.plant_feet").plant_feet, motion, contacts)

    with pytest.raises(load("solvers.errors").InvalidMotionError) as caught:
        job(solve).result()

    assert "plant_feet" in "".join(caught.value.__notes__)


def test_a_process_that_dies_is_mourned_in_a_sentence(job, load, problem):
    before = folders()
    running = job(partial(load("solvers.denoising").denoise, problem(20_000)))

    os.kill(running._process.pid, signal.SIGKILL)

    with pytest.raises(
        load("solvers.errors").MocapAssistError, match="by signal SIGKILL, which"
    ):
        running.result()
    assert folders() == before


def test_messages_in_the_log_are_told_from_progress(load, tmp_path):
    protocol = load("mocap_assist.jobs.protocol")
    lines = ["@0.1000 Reading", "ImportError: no such module", "@0.2500 Filtering 1 of 2", ""]
    (tmp_path / protocol.LOG).write_text("\n".join(lines))

    assert protocol.last_progress(tmp_path) == (0.25, "Filtering 1 of 2")
    assert protocol.last_words(tmp_path) == "ImportError: no such module"


@pytest.fixture
def pressed(load, blank, monkeypatch):
    """A button whose solve takes long, pressed in a Blender that pretends to have windows."""
    modal = load("mocap_assist.solver_operator")
    seen = SimpleNamespace(timers=[], status=[], reports=[], written=[])
    manager = SimpleNamespace(
        event_timer_add=lambda *_, **__: seen.timers.append("timer") or "timer",
        event_timer_remove=seen.timers.remove,
        modal_handler_add=lambda _: None,
        mocap_assist_job=blank.context.window_manager.mocap_assist_job,
        windows=[],
    )
    seen.context = SimpleNamespace(
        window_manager=manager,
        window=None,
        workspace=SimpleNamespace(status_text_set=seen.status.append),
    )

    class Button(modal.SolverOperator):
        bl_idname = "mocap_assist.test"

        def prepare(self, context):
            pass

        def read(self, context):
            return seen.solve

        def write(self, context, result):
            seen.written.append(result)
            return "Done."

        def report(self, kind, message):
            seen.reports.append((kind, message))

    seen.button = Button()
    monkeypatch.setattr(modal, "in_background", lambda: False)
    return seen


def event(kind, value="NOTHING"):
    return SimpleNamespace(type=kind, value=value)


@pytest.mark.parametrize("key", ["ESC", "RIGHTMOUSE"])
def test_escape_ends_the_solve_and_writes_nothing(pressed, load, problem, key):
    pressed.solve = partial(load("solvers.denoising").denoise, problem(20_000))
    before = folders()

    assert pressed.button.invoke(pressed.context, None) == {"RUNNING_MODAL"}
    state = pressed.context.window_manager.mocap_assist_job
    assert state.running and pressed.status[-1] == "Starting 0%   Esc: cancel"
    assert pressed.button.modal(pressed.context, event("TIMER")) == {"RUNNING_MODAL"}
    assert pressed.button.modal(pressed.context, event("LEFTMOUSE", "PRESS")) == {
        "RUNNING_MODAL"
    }
    assert pressed.button.modal(pressed.context, event(key, "PRESS")) == {"CANCELLED"}

    assert pressed.written == [] and pressed.timers == [] and pressed.status[-1] is None
    assert not state.running and folders() == before
    assert pressed.reports == [({"INFO"}, "Cancelled.")]


def test_a_finished_solve_is_written(pressed, load, problem):
    pressed.solve = partial(load("solvers.denoising").denoise, problem(30))
    pressed.button.invoke(pressed.context, None)

    while (outcome := pressed.button.modal(pressed.context, event("TIMER"))) == {
        "RUNNING_MODAL"
    }:
        time.sleep(0.05)

    assert outcome == {"FINISHED"} and pressed.reports == [({"INFO"}, "Done.")]
    assert pressed.written[0].recording.n_frames == 30
    assert pressed.timers == [] and pressed.status[-1] is None


def test_closing_blender_ends_the_solve(pressed, load, problem):
    pressed.solve = partial(load("solvers.denoising").denoise, problem(20_000))
    before = folders()
    pressed.button.invoke(pressed.context, None)

    pressed.button.cancel(pressed.context)

    assert pressed.written == [] and folders() == before
