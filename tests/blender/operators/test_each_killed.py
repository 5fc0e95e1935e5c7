"""A killed `each` leaves no Blender behind, and is taken up again without a second one."""

import subprocess
import sys
import tempfile
from threading import Event

import pytest
from process_checks import descendants_of, wait_until_gone

RECORDS = ".mocap_assist"
"""Folder of what is kept about each take."""


@pytest.fixture(autouse=True)
def scratch(tmp_path, monkeypatch):
    """An own folder for temporary files, also of processes that are started."""
    folder = tmp_path / "scratch"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(folder))
    return folder


@pytest.fixture
def module(load):
    return load("mocap_assist.batch.each_child")


class Stopped:
    """An Event that may be checked at most three times."""

    def __init__(self, third):
        self.n_waits, self.third = 0, third

    def wait(self, seconds):
        self.n_waits += 1
        return self.third() if self.n_waits == 3 else False


@pytest.fixture
def each(load, tmp_path):
    """Start `each` on four takes in a Blender of its own."""
    samples, recordings = load("solvers.samples"), load("solvers.recordings")
    takes = tmp_path / "takes"
    takes.mkdir()
    for number in range(4):
        walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
        recordings.write_bvh(walk, takes / f"{number:02}.bvh")
    module = load("mocap_assist.batch.each_verb")
    words = [module.PACKAGE, "", "each", str(takes), "--output-folder", str(tmp_path / "out")]

    def start(*last):
        return subprocess.Popen(
            [sys.executable, "-c", module.MODULE_CHILD, *words, *last, "--", "import"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip

    return start


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_no_blender_continues_when_each_is_killed(each, tmp_path, scratch):
    with each("--jobs", "2") as running:
        while not list(tmp_path.glob("out/*.blend")):
            assert running.poll() is None
        blenders = descendants_of(running.pid)
        running.kill()
    assert blenders
    assert not wait_until_gone(blenders)
    n_made = len(list(tmp_path.glob("out/*.blend")))
    assert list(scratch.glob("mocap_assist_*"))

    with each("--jobs", "2") as again:
        message, _ = again.communicate()

    assert again.returncode == 0
    assert message.count("Already made.") <= n_made
    assert len(list(tmp_path.glob("out/*.blend"))) == 4
    assert not list(scratch.glob("mocap_assist_*"))
    hidden = [path.name for path in tmp_path.glob("out/*") if path.name.startswith(".")]
    assert hidden == [RECORDS]
    assert all(path.suffix == ".json" for path in tmp_path.glob(f"out/{RECORDS}/*"))


def test_second_blender_does_not_start_while_one_writes_the_file(module, load, tmp_path):
    scratch_module = load("solvers.processes.scratch")
    target = tmp_path / "take.blend"
    lock = load("solvers.processes.locks").try_lock(scratch_module.lock_for_work_on(target))
    command = [sys.executable, "-c", f"open({str(target)!r}, 'x')"]

    def release():
        assert not target.exists()
        lock.release()
        return False

    stopped = Stopped(release)

    assert module.run_child(command, target, stopped) == (0, "")
    assert stopped.n_waits == 3
    assert target.exists()


def test_no_blender_starts_after_a_cancel(module, load, tmp_path):
    scratch_module = load("solvers.processes.scratch")
    target = tmp_path / "take.blend"
    lock = load("solvers.processes.locks").try_lock(scratch_module.lock_for_work_on(target))

    stopped = Stopped(lambda: True)

    assert module.run_child([], target, stopped) is None
    lock.release()


def test_blender_locks_its_file_and_reports_the_holder(module, load, tmp_path, monkeypatch):
    monkeypatch.setattr(module, "end_with_stdin", lambda: None)
    monkeypatch.setattr(module, "LOCK_TIMEOUT_S", 0.0)
    target = tmp_path / "take.blend"

    with module.lock_target(target):
        assert module._is_locked(target)
        with (
            pytest.raises(
                load("solvers.errors").InvalidFileError, match="Another Blender process is"
            ),
            module.lock_target(target),
        ):
            pytest.fail("two work on one file")

    assert not module._is_locked(target)


def test_errors_of_a_child_are_returned_and_its_input_stays_open(module, tmp_path):
    code = (
        "import os, select, sys\n"
        "closed = select.select([0], [], [], 0.2)[0]\n"
        "sys.stderr.write('a sentence\\n')\n"
        "sys.exit(3 if closed else 2)\n"
    )
    command = [sys.executable, "-c", code]

    ended = module.run_child(command, tmp_path / "take.blend", Event())

    assert ended == (2, "a sentence\n")
