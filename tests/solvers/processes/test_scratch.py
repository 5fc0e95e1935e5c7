"""Scratch folders are private, go with their owner, and are cleared if that was killed."""

import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from solvers.errors import InvalidFileError
from solvers.processes.locks import try_lock
from solvers.processes.scratch import (
    ScratchFolder,
    clear_abandoned,
    lock_for_work_on,
    remove_orphaned,
)

ROOT = Path(__file__).parents[3]
KILLED = """
import os, signal
from solvers.processes.scratch import ScratchFolder
scratch = ScratchFolder()
(scratch.path / "half").write_text("half")
os.kill(os.getpid(), signal.SIGKILL)
"""
HOLDING = """
import sys
from solvers.processes.scratch import ScratchFolder
with ScratchFolder() as scratch:
    print(scratch.path, flush=True)
    sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    """An own folder for temporary files, also of processes that are started."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    return tmp_path


def leave_behind() -> None:
    done = subprocess.run([sys.executable, "-c", KILLED], check=False)
    assert done.returncode == -signal.SIGKILL


def test_folder_is_private_and_goes_with_its_lock(place):
    with ScratchFolder() as scratch:
        (scratch.path / "file").write_text("")
        assert scratch.path.parent == place
        assert scratch.path.stat().st_mode & 0o077 == 0

    assert not list(place.iterdir())


def test_folder_goes_when_nobody_refers_to_it(place):
    scratch = ScratchFolder()
    assert scratch.path.is_dir()

    del scratch

    assert not list(place.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_folder_of_a_killed_process_is_cleared_by_the_next(place):
    leave_behind()
    assert len(list(place.iterdir())) == 2

    subprocess.run([sys.executable, "-c", HOLDING], stdin=subprocess.DEVNULL, check=True)

    assert not list(place.iterdir())


def test_folder_in_use_stays_when_others_are_cleared(place):
    held = ScratchFolder()
    with subprocess.Popen(
        [sys.executable, "-c", HOLDING],
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        path = Path(other.stdout.readline().strip())

        clear_abandoned(place)

        assert path.is_dir() and held.path.is_dir()
        assert len(list(place.iterdir())) == 4
        other.stdin.close()


def test_what_is_not_ours_stays_when_scratch_is_cleared(place, monkeypatch):
    (place / "mocap_assist_of_an_artist").mkdir()
    (place / "other.lock").touch()
    leave_behind()
    if hasattr(os, "getuid"):
        user = os.getuid()
        monkeypatch.setattr(os, "getuid", lambda: user + 1)
        clear_abandoned(place)
        assert len(list(place.iterdir())) == 4
        monkeypatch.undo()

    clear_abandoned(place)

    assert {path.name for path in place.iterdir()} == {
        "mocap_assist_of_an_artist",
        "other.lock",
    }


@pytest.mark.skipif(sys.platform == "win32", reason="needs links")
def test_nothing_is_removed_through_a_link_when_scratch_is_cleared(place):
    (place / "precious").mkdir()
    (place / "precious" / "file").write_text("")
    (place / "mocap_assist_0").symlink_to(place / "precious")
    (place / "mocap_assist_0.lock").touch()
    (place / "mocap_assist_1.lock").symlink_to(place / "precious" / "file")

    clear_abandoned(place)

    assert (place / "precious" / "file").is_file()


def test_orphan_removes_the_folder_and_its_lock(place):
    (place / "mocap_assist_0").mkdir()
    (place / "mocap_assist_0" / "half").touch()
    (place / "mocap_assist_0.lock").touch()

    remove_orphaned(place / "mocap_assist_0")

    assert not list(place.iterdir())


def test_folder_that_cannot_be_made_is_one_sentence(place, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(place / "gone"))
    with pytest.raises(
        InvalidFileError, match=r"Temporary files cannot be written in .*gone: No"
    ):
        ScratchFolder()


def test_lock_is_held_once_and_free_after_its_release(place):
    path = lock_for_work_on(place / "take.blend")
    lock = try_lock(path)
    assert lock is not None
    assert try_lock(path) is None
    assert try_lock(lock_for_work_on(place / "other.blend")) is not None

    lock.release()

    assert not path.exists()
    again = try_lock(path)
    assert again is not None
    again.release()


def test_lock_is_taken_on_the_new_file_when_its_holder_removes_the_old(place, monkeypatch):
    """Between the opening of a file and its locking, whoever held it may remove it."""
    path = place / "a.lock"
    first = try_lock(path)
    real = os.open
    opened = []

    def open_then_release(*arguments):
        opened.append(real(*arguments))
        if len(opened) == 1:
            first.release()
        return opened[-1]

    monkeypatch.setattr(os, "open", open_then_release)
    second = try_lock(path)
    monkeypatch.undo()

    assert second is not None and len(opened) == 2
    assert path.exists() and try_lock(path) is None
    second.release()
