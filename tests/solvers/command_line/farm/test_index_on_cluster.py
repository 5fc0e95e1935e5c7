"""Workers of a Dask cluster describe clips; the library is that of one process."""

import os
import signal
import sys
from importlib.util import find_spec

import pytest
from clusters.dask_cluster import local_cluster

from solvers.command_line.farm import cluster_workers
from solvers.errors import MocapAssistError
from solvers.processes import is_running
from solvers.recordings import write_bvh
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import index_files


@pytest.fixture
def takes(tmp_path):
    """Twelve walks, each shorter than the one before, and a damaged file."""
    folder = tmp_path / "takes"
    folder.mkdir()
    for number in range(12):
        settings = GaitSettings(duration=3.0 - 0.2 * number, frame_rate=30.0)
        write_bvh(walking_gait(settings), folder / f"take{number:02}.bvh")
    (folder / "take05a.bvh").write_text("HIERARCHY\nROOT")
    return folder


def kill(find_process):
    """Return a Progress that kills a process, once the fifth file is described."""
    killed = list[int]()

    def progress(fraction, message=""):
        if message == "take04.bvh" and not killed:
            killed.append(find_process())
            os.kill(killed[0], signal.SIGKILL)

    return progress, killed


@pytest.mark.skipif(find_spec("distributed") is None, reason="needs the package distributed")
def test_killed_worker_changes_no_byte_and_a_run_that_lost_its_scheduler_continues(
    call, takes, tmp_path, monkeypatch
):
    expected, again = tmp_path / "expected.clips", tmp_path / "again.clips"
    monkeypatch.setattr(sys.modules["solvers.workflows.index_files"], "MAX_BATCH_CLIPS", 4)
    refused = index_files(expected, [takes]).refused

    with local_cluster(2) as address:
        with cluster_workers(address, [takes]) as workers:
            client = workers._client
            progress, killed = kill(lambda: min(client.run(os.getpid).values()))
            index_files(tmp_path / "a.clips", [takes], workers=workers, progress=progress)
        assert killed and not is_running(killed[0])

        words = ("index", tmp_path / "b.clips", takes, "--cluster", address)
        assert call(*words) == (
            2,
            f"12 added, 1 refused; {tmp_path / 'b.clips'} has 12 clips.\n",
            f"{refused[0][1]}\n",
        )

        with (
            pytest.raises(MocapAssistError, match=f"The scheduler {address} is gone"),
            cluster_workers(address, [takes]) as workers,
        ):
            progress, killed = kill(lambda: workers._client.run_on_scheduler(os.getpid))
            index_files(again, [takes], workers=workers, progress=progress)

    for name in ("a.clips", "b.clips"):
        assert (tmp_path / name).read_bytes() == expected.read_bytes()
    assert killed
    report = index_files(again, [takes])
    assert (len(report.unchanged), report.n_clips) == (4, 12)


def test_recordings_that_workers_do_not_see_are_one_sentence(call, takes, monkeypatch):
    """Otherwise each file would be refused, and its earlier clip removed."""
    indexed = []

    def connect(address, paths):
        indexed.extend(paths)
        raise MocapAssistError("A worker does not see them.")

    monkeypatch.setattr("solvers.command_line.library_verbs.cluster_workers", connect)
    library = takes.parent / "a.clips"

    words = ("index", library, takes / "take00.bvh", takes, "--cluster", "tcp://farm:1")
    assert call(*words)[::2] == (2, f"{library}: A worker does not see them.\n")
    assert indexed == [takes.resolve()]
    assert not library.exists()
