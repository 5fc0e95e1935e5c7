"""A solve in a process of its own: same answer, prompt end, no trace."""

import os
import signal
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from process_checks import is_running, start_with_extension, wait_until_gone


@pytest.fixture
def job(load):
    return load("mocap_assist.jobs.job").Job


@pytest.fixture
def problem(load, rng):
    """A leg that shakes, of so many frames."""
    motion = load("solvers.motion")
    representations = load("solvers.rotations.representations")
    skeleton = motion.Skeleton(("hip", "knee"), (-1, 0), np.array([[0, 0, 0.9], [0, 0, -0.4]]))

    def make(n_frames):
        vectors = rng.normal(scale=0.1, size=(n_frames, 2, 3))
        rotations = representations.quaternion_from_rotation_vector(vectors)
        return motion.Motion(skeleton, rotations, np.zeros((n_frames, 3)), 30.0)

    return make


@pytest.fixture(autouse=True)
def own_temporary_folder(tmp_path, monkeypatch):
    """Others that solve on this machine at the same time leave their folders elsewhere."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def folders():
    return set(Path(tempfile.gettempdir()).glob("mocap_assist_*"))


def test_job_result_equals_that_of_this_process(job, load, problem):
    solve = partial(load("solvers.denoising").denoise, problem(60))

    found = job(solve).result().recording

    np.testing.assert_allclose(found.rotations, solve().recording.rotations, atol=1e-9)


def test_cancel_ends_the_job_and_removes_its_files(job, load, problem):
    before = folders()
    running = job(partial(load("solvers.denoising").denoise, problem(20_000)))
    while running.progress() == (0.0, "Starting") and not running.done():
        time.sleep(0.05)

    running.cancel()

    with pytest.raises(load("solvers.errors").SolveCancelled):
        running.result()
    assert running.done()
    assert folders() == before


def test_solver_error_is_raised_with_its_traceback(job, load, problem):
    motion = problem(10)
    contacts = np.zeros((3, 2), bool)
    solve = partial(load("solvers.feet.plant_feet").plant_feet, motion, contacts)

    with pytest.raises(load("solvers.errors").InvalidMotionError) as caught:
        job(solve).result()

    assert "plant_feet" in "".join(caught.value.__notes__)


def test_crashed_process_is_reported_in_one_sentence(job, load, problem):
    before = folders()
    running = job(partial(load("solvers.denoising").denoise, problem(20_000)))

    os.kill(running._child.process.pid, signal.SIGKILL)

    with pytest.raises(
        load("solvers.errors").MocapAssistError, match="early: signal SIGKILL, which"
    ):
        running.result()
    assert folders() == before


def test_log_separates_output_from_progress(load, tmp_path):
    protocol = load("mocap_assist.jobs.protocol")
    lines = ["@0.1000 Reading", "ImportError: no such module", "@0.2500 Filtering 1 of 2", ""]
    (tmp_path / protocol.LOG).write_text("\n".join(lines))

    assert protocol.last_progress(tmp_path) == (0.25, "Filtering 1 of 2")
    assert protocol.last_output(tmp_path) == "ImportError: no such module"


class Expression:
    """A function that can be sent to the child, which cannot import this file."""

    def __init__(self, text):
        self.text = text

    def __reduce__(self):
        return eval, (self.text,)


def test_child_imports_from_blenders_paths_only(job):
    expression = (
        "lambda progress: (lambda sys: (sys.flags.no_user_site, sys.flags.safe_path,"
        " sys.path))(__import__('sys'))"
    )

    no_user_site, safe_path, path = job(Expression(expression)).result()

    assert (no_user_site, safe_path) == (1, True)
    here = [Path(each) for each in sys.path if each]
    scripts = [each for each in here if "scripts" in each.parts]
    expected = [each.resolve() for each in here if each not in scripts]
    expected += [each.resolve() for each in scripts]
    assert scripts
    assert [Path(each).resolve() for each in path[: len(expected)]] == expected


WAITING = """
import sys, time
from pathlib import Path
sys.path.insert(0, {jobs!r})
import child
child.make_importable({package!r}, Path({extension!r}))
from {package}.mocap_assist.jobs.job import Job

class Expression:
    def __reduce__(self):
        return eval, ("lambda progress: __import__('time').sleep(100)",)

running = Job(Expression())
print(running._child.process.pid, flush=True)
time.sleep(100)
"""


def test_child_ends_when_blender_is_killed(job, extension, tmp_path):
    """Even in the middle of a step that reports no progress."""
    with start_with_extension(WAITING, extension, tmp_path) as blender:
        child = int(blender.stdout.readline())
        assert is_running(child) and folders()
        blender.kill()

    assert not wait_until_gone({child})
    assert not folders()
