"""What a killed writer left behind is cleared up, and nothing else."""

import errno
import os
import signal
import sys
from subprocess import run

import pytest

from solvers.errors import InvalidFileError
from solvers.files import read_regular, remove_leftovers, write_atomically

KILLED = """
import os, signal, sys
from solvers.files import write_atomically
with write_atomically(sys.argv[1]) as part:
    part.write_text("half")
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs leases")
def test_file_with_a_lease_is_read_once_it_is_given_up(tmp_path):
    fcntl = pytest.importorskip("fcntl")
    path = tmp_path / "a.json"
    path.write_text("{}")
    holder = os.open(path, os.O_WRONLY)

    def give_up(*_):
        fcntl.fcntl(holder, fcntl.F_SETLEASE, fcntl.F_UNLCK)

    before = signal.signal(signal.SIGIO, give_up)
    try:
        fcntl.fcntl(holder, fcntl.F_SETLEASE, fcntl.F_WRLCK)
        assert read_regular(path, 10) == b"{}"
    finally:
        signal.signal(signal.SIGIO, before)
        os.close(holder)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_full_disk_is_reported(tmp_path, number):
    with (
        pytest.raises(InvalidFileError, match="written: the disk is full"),
        write_atomically(tmp_path / "a.bvh"),
    ):
        raise OSError(number, os.strerror(number))


def test_remains_of_a_killed_writer_are_deleted_and_files_stay(tmp_path):
    target = (
        tmp_path / "walk [1] of a very long name that is cut, because some are too long.bvh"
    )
    target.write_text("whole")
    mine = {".walk [1].bvh", ".walk.0123456789ab.bvh", ".hidden", "walk.0123456789ab.bvh"}
    for name in mine:
        (tmp_path / name).write_text("an animator's own")

    status = run([sys.executable, "-c", KILLED, target], check=False).returncode
    left = {path.name for path in tmp_path.iterdir()} - mine - {target.name}
    remove_leftovers([target, tmp_path / "nowhere" / "other.bvh"])

    assert status != 0
    assert len(left) == 1
    assert {path.name for path in tmp_path.iterdir()} == mine | {target.name}
    assert target.read_text() == "whole"


def test_a_writer_that_fails_leaves_nothing(tmp_path):
    try:
        with write_atomically(tmp_path / "a.txt") as part:
            part.write_text("half")
            raise ZeroDivisionError
    except ZeroDivisionError:
        pass

    assert not list(tmp_path.iterdir())


def test_file_is_synced_before_it_gets_its_name(tmp_path, monkeypatch):
    target, done = tmp_path / "out.txt", []
    monkeypatch.setattr(
        "os.fsync", lambda descriptor: done.append(os.fstat(descriptor).st_size)
    )

    with write_atomically(target) as part:
        part.write_text("whole")

    assert (done, target.read_text()) == ([5], "whole")
