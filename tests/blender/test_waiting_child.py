"""A process that waits for the next solve: used once, ended with Blender, never missed."""

import operator
import tempfile
import time
from pathlib import Path

import pytest
from process_checks import is_running, start_with_extension, wait_until_gone

OWN_PID = "lambda progress: __import__('os').getpid()"
MODULES = "lambda progress: sorted(__import__('sys').modules)"
KEEPER = """
import sys, time
from pathlib import Path
sys.path.insert(0, {jobs!r})
import child
child.make_importable({package!r}, Path({extension!r}))
from {package}.mocap_assist.jobs import waiting_child
waiting_child.keep_waiting()
print(waiting_child._waiting[0].process.pid, flush=True)
time.sleep(100)
"""


class Expression:
    """A function that can be sent to the child, which cannot import this file."""

    def __init__(self, text):
        self.text = text

    def __reduce__(self):
        return eval, (self.text,)


class Then:
    """A solve that also returns the modules that its process has imported by then."""

    def __init__(self, solve):
        self.solve = solve

    def __reduce__(self):
        text = "lambda solve: lambda progress: (solve(progress=progress), [*%s])"
        return operator.call, (Expression(text % "__import__('sys').modules"), self.solve)


@pytest.fixture(autouse=True)
def own_temporary_folder(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


@pytest.fixture
def job(load):
    return load("mocap_assist.jobs.job").Job


@pytest.fixture
def waiting(load):
    """The module; its process is ended after the test."""
    module = load("mocap_assist.jobs.waiting_child")
    module.end_waiting()
    yield module
    module.end_waiting()


def pid_of(waiting):
    return waiting._waiting[0].process.pid


def test_solve_takes_the_process_that_waits_once(waiting, job):
    waiting.keep_waiting()
    expected = pid_of(waiting)
    waiting.keep_waiting()  # still the same

    assert pid_of(waiting) == expected
    assert job(Expression(OWN_PID)).result() == expected
    assert waiting.take_waiting() is None
    assert job(Expression(OWN_PID)).result() != expected
    assert not list(Path(tempfile.gettempdir()).glob("mocap_assist_*"))


def test_press_imports_nothing_that_was_not_imported_ahead(
    waiting, job, load, blank, actor, monkeypatch
):
    """What it imports when it is called is what the animator waits for."""
    waiting.keep_waiting()
    ahead = set(job(Expression(MODULES)).result())
    late = []

    def run(solve, *_):
        waiting.keep_waiting()
        result, modules = job(Then(solve)).result()
        late.append({name for name in set(modules) - ahead if "encodings" not in name})
        return result

    monkeypatch.setattr(load("mocap_assist.runtime.solver_operator"), "run", run)

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}
    assert late == [set(), set()]


@pytest.mark.parametrize("how", ["killed", "folder removed"])
def test_process_that_is_gone_is_not_missed(waiting, job, how):
    waiting.keep_waiting()
    child = waiting._waiting[0]
    if how == "killed":
        child.process.kill()
        child.process.wait()
    else:
        for path in child.path.iterdir():
            path.unlink()
        child.path.rmdir()

    assert job(Expression(OWN_PID)).result() != child.process.pid
    assert not wait_until_gone({child.process.pid})


def test_process_killed_at_the_last_moment_is_replaced(waiting, job, monkeypatch):
    waiting.keep_waiting()
    child = waiting._waiting[0]
    child.process.kill()
    child.process.wait()
    monkeypatch.setattr(child, "is_waiting", lambda: True)

    assert job(Expression(OWN_PID)).result() != 0


def test_process_that_another_thread_takes_is_not_missed(waiting, monkeypatch):
    """Threads start solves: the first one may take it while the second looks at it."""
    waiting.keep_waiting()
    child = waiting._waiting[0]
    look, taken = child.is_waiting, []

    def is_waiting():
        if not taken:
            taken.append(None)
            taken.append(waiting.take_waiting())
        return look()

    monkeypatch.setattr(child, "is_waiting", is_waiting)
    first = waiting.take_waiting()

    assert [first, taken[1]].count(child) == 1
    child.abandon()


def test_other_programs_and_threads_start_their_own(waiting, job):
    waiting.keep_waiting()
    expected = pid_of(waiting)

    assert job(Expression(OWN_PID), n_threads=2).result() != expected
    assert pid_of(waiting) == expected


def test_process_that_waits_ends_when_blender_is_killed(extension, tmp_path):
    with start_with_extension(KEEPER, extension, tmp_path) as blender:
        child = int(blender.stdout.readline())
        assert is_running(child)
        blender.kill()

    assert not wait_until_gone({child})
    for _ in range(100):
        if not list(tmp_path.glob("mocap_assist_*")):
            break
        time.sleep(0.05)
    assert not list(tmp_path.glob("mocap_assist_*"))
