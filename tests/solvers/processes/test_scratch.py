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
def folder(tmp_path, monkeypatch):
    """An own folder for temporary files, also of processes that are started."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    for name in ("TMPDIR", "TEMP", "TMP"):
        monkeypatch.setenv(name, str(tmp_path))
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    return tmp_path


def leave_behind() -> None:
    done = subprocess.run([sys.executable, "-c", KILLED], check=False)
    assert done.returncode == -signal.SIGKILL


def test_folder_is_private_and_deleted_with_its_lock(folder):
    with ScratchFolder() as scratch:
        (scratch.path / "file").write_text("")
        assert scratch.path.parent == folder
        assert scratch.path.stat().st_mode & 0o077 == 0

    assert not list(folder.iterdir())


def test_folder_is_deleted_without_references(folder):
    scratch = ScratchFolder()
    assert scratch.path.is_dir()

    del scratch

    assert not list(folder.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_folder_of_a_killed_process_is_deleted_by_the_next(folder):
    leave_behind()
    assert len(list(folder.iterdir())) == 2

    subprocess.run([sys.executable, "-c", HOLDING], stdin=subprocess.DEVNULL, check=True)

    assert not list(folder.iterdir())


def test_folder_in_use_stays_when_others_are_cleared(folder):
    held = ScratchFolder()
    with subprocess.Popen(
        [sys.executable, "-c", HOLDING],
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        path = Path(other.stdout.readline().strip())

        clear_abandoned(folder)

        assert path.is_dir() and held.path.is_dir()
        assert len(list(folder.iterdir())) == 4
        other.stdin.close()


def test_foreign_files_stay_when_scratch_is_cleared(folder, monkeypatch):
    (folder / "mocap_assist_of_an_artist").mkdir()
    (folder / "other.lock").touch()
    leave_behind()
    if hasattr(os, "getuid"):
        user = os.getuid()
        monkeypatch.setattr(os, "getuid", lambda: user + 1)
        clear_abandoned(folder)
        assert len(list(folder.iterdir())) == 4
        monkeypatch.undo()

    clear_abandoned(folder)

    assert {path.name for path in folder.iterdir()} == {
        "mocap_assist_of_an_artist",
        "other.lock",
    }


@pytest.mark.skipif(sys.platform == "win32", reason="needs links")
def test_nothing_is_removed_through_a_link_when_scratch_is_cleared(folder):
    (folder / "precious").mkdir()
    (folder / "precious" / "file").write_text("")
    (folder / "mocap_assist_0").symlink_to(folder / "precious")
    (folder / "mocap_assist_0.lock").touch()
    (folder / "mocap_assist_1.lock").symlink_to(folder / "precious" / "file")

    clear_abandoned(folder)

    assert (folder / "precious" / "file").is_file()


def test_orphan_removes_the_folder_and_its_lock(folder):
    (folder / "mocap_assist_0").mkdir()
    (folder / "mocap_assist_0" / "half").touch()
    (folder / "mocap_assist_0.lock").touch()

    remove_orphaned(folder / "mocap_assist_0")

    assert not list(folder.iterdir())


def test_folder_that_cannot_be_made_gives_one_sentence(folder, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(folder / "gone"))
    with pytest.raises(
        InvalidFileError, match=r"Temporary files cannot be written in .*gone: No"
    ):
        ScratchFolder()


def test_lock_is_held_once_and_free_after_its_release(folder):
    path = lock_for_work_on(folder / "take.blend")
    lock = try_lock(path)
    assert lock is not None
    assert try_lock(path) is None
    assert try_lock(lock_for_work_on(folder / "other.blend")) is not None

    lock.release()

    assert not path.exists()
    again = try_lock(path)
    assert again is not None
    again.release()


def test_lock_is_taken_on_the_new_file_when_its_holder_removes_the_old(folder, monkeypatch):
    """Between opening and locking a file, its holder may remove it."""
    path = folder / "a.lock"
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
