"""A batch on the workers of a Dask cluster: none of it is lost, and no take is made twice."""

import io
import json
import os
import re
import sys
from collections import Counter
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor
from contextlib import contextmanager, nullcontext, redirect_stderr, redirect_stdout
from importlib.util import find_spec

import pytest
from clusters.dask_cluster import DEADLY_VERBS, local_cluster

from solvers.command_line.batches import parallel
from solvers.command_line.farm import cluster as cluster_module
from solvers.command_line.run import run
from solvers.command_line.sharing import Records
from solvers.command_line.verbs import VERBS

NEEDS_DASK = pytest.mark.skipif(
    find_spec("distributed") is None, reason="needs the package distributed"
)


@pytest.fixture(scope="module")
def cluster():
    """The address of a cluster of two worker processes."""
    with local_cluster(2) as address:
        yield address


@pytest.fixture
def deadly(capsys):
    """Run the verb that ends workers; returns exit status, stdout, stderr."""

    def command(*words) -> tuple[int, str, str]:
        status = run(DEADLY_VERBS, ["deadly", *map(str, words)], "solvers")
        captured = capsys.readouterr()
        return status, captured.out, captured.err

    return command


@NEEDS_DASK
def test_killed_workers_lose_no_take_and_none_is_made_twice(
    deadly, cluster, small_batch, tmp_path, records_in, monkeypatch
):
    (small_batch / "take03.bvh").rename(small_batch / "kills_once.bvh")
    (small_batch / "take07.bvh").rename(small_batch / "kills.bvh")
    names = {path.name for path in small_batch.iterdir()}
    monkeypatch.chdir(tmp_path)  # Workers have another working folder.

    status, printed, err = deadly("takes", "--output-folder", "out", "--cluster", cluster)

    # A result that its worker could not send any more is made already.
    n_made = printed.count("learned\n") + printed.count("Already made.\n")
    assert (status, n_made) == (2, len(names) - 1)
    assert err == (
        "takes/kills.bvh: its process crashed, perhaps for lack of memory. Process a part of"
        " the take, or start workers with more memory.\n"
    )
    made = Counter((tmp_path / "made").read_text().split())
    assert made == {name.removesuffix(".bvh"): 1 for name in names - {"kills.bvh"}}
    records = records_in(tmp_path / "out")
    assert {name for name, each in records.items() if each["error"]} == {"kills.bvh"}
    assert set(records) == names
    assert not list((tmp_path / "out").rglob("*.claim"))


@NEEDS_DASK
def test_scheduler_that_ends_is_one_sentence(deadly, small_batch, tmp_path):
    (small_batch / "take23.bvh").rename(small_batch / "ends.bvh")
    words = [small_batch, "--output-folder", tmp_path / "out"]

    with local_cluster(1) as address:
        status, _, err = deadly(*words, "--cluster", address)

    assert (status, err) == (
        2, f"The scheduler {address} is gone; the batch stops. Run it again to continue.\n",
    )  # fmt: skip


@NEEDS_DASK
def test_output_folder_that_vanishes_is_one_sentence(
    call, cluster, small_batch, tmp_path, records_in
):
    out, aside = tmp_path / "out", tmp_path / "aside"
    hook = f"{sys.executable} -c 'import os, sys; os.rename(*sys.argv[1:])' {out} {aside}"
    words = ["convert", small_batch, "--output-folder", out, "--cluster", cluster]

    status, _, err = call(*words, "--report", "--after", hook)

    assert (status, out.exists()) == (2, False)
    assert err == (
        f"The output folder {out} is gone; the batch stops. Run it again to continue.\n"
    )
    assert records_in(aside)


@NEEDS_DASK
def test_scheduler_that_cannot_be_reached_is_one_sentence(
    call, leg_file, tmp_path, monkeypatch
):
    monkeypatch.setattr(cluster_module, "CONNECTION_TIMEOUT_S", 0.2)
    words = ["convert", leg_file, "--output-folder", tmp_path / "out", "--cluster"]

    for address in ("tcp://127.0.0.1:9", "farm"):
        status, _, err = call(*words, address)

        assert (status, err) == (
            2,
            f"There is no scheduler at {address}, or it cannot be reached. Start one with dask"
            " scheduler, or correct the address.\n",
        )


def test_missing_dask_is_one_sentence(call, leg_file, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)

    status, _, err = call(
        "convert", leg_file, "--output-folder", tmp_path / "out", "--cluster", "tcp://farm:1"
    )

    assert (status, err) == (
        2,
        "--cluster needs the Python package distributed, which is not installed here. Install"
        " it: python -m pip install distributed.\n",
    )


def test_threads_of_a_cluster_are_refused(call, leg_file, tmp_path):
    words = ["convert", leg_file, "--output-folder", tmp_path / "out", "--cluster", "tcp://x:1"]

    status, _, err = call(*words, "--threads", "2")

    assert (status, err.count("\n")) == (2, 1)
    assert err.startswith("The workers of a cluster choose their threads")


class OneThread:
    """Workers in this process, which act as those of other machines."""

    batch, max_crashes, advice = "batch", 1, ""

    @contextmanager
    def open(self, n_tasks):
        with ThreadPoolExecutor(1) as executor:
            yield executor

    def share(self, value):
        return value


class DeadThread(OneThread):
    """A worker that has died of each take."""

    @contextmanager
    def open(self, n_tasks):
        yield self

    def submit(self, *arguments):
        raise BrokenExecutor

    def shutdown(self, **options):
        """End at once."""


@pytest.fixture
def lost_claim(leg_file, tmp_path, monkeypatch):
    """A claim on a take, of a worker on another machine that was killed; what the batch waits.

    Each wait ages it by 200 s.
    """
    records = Records(tmp_path / "out")
    records.prepare()
    claim = records.claim("leg.bvh")
    claim = claim.with_name(f"{claim.name}.1.claim")
    waited = []

    def age(seconds):
        waited.append(seconds)
        now = claim.stat().st_mtime
        os.utime(claim, (now - 200.0, now - 200.0))

    def write(batch):
        claim.write_text(
            json.dumps({"host": "farm", "machine": "farm", "pid": 1, "batch": batch})
        )
        return waited

    monkeypatch.setattr(parallel, "sleep", age)
    return write


@pytest.fixture
def use_workers(monkeypatch):
    """Run batches on these workers."""

    def use(workers):
        monkeypatch.setattr(
            "solvers.command_line.run_verb.workers_for", lambda tasks: nullcontext(workers)
        )

    return use


def test_terminal_shows_how_many_takes_of_workers_are_done(small_batch, tmp_path, use_workers):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    use_workers(OneThread())
    words = ["convert", str(small_batch), "--output-folder", str(tmp_path / "out")]
    with redirect_stderr(Terminal()) as shown, redirect_stdout(io.StringIO()):
        assert run(VERBS, words, "solvers") == 0

    counts = re.findall(r"\[(\d+)/24\]", shown.getvalue())
    assert [*map(int, counts)] == [*range(25)]
    assert shown.getvalue().endswith(" \r"), "the last count stays before the shell's prompt"


@pytest.mark.parametrize("batch", ["batch", "another"])
def test_take_of_a_lost_worker_waits_for_its_claim(
    call, leg_file, tmp_path, lost_claim, use_workers, batch
):
    """The claim ends after five minutes."""
    waited = lost_claim(batch)
    use_workers(OneThread())

    status, printed, _ = call("convert", leg_file, "--output-folder", tmp_path / "out")

    assert status == 0
    if batch == "batch":
        assert ("120 frames" in printed, len(waited)) == (True, 2)
    else:
        sentence = "Skipped: another process on farm is working on it.\n"
        assert (printed, waited) == (sentence, [])


def test_crash_is_recorded_once_the_claim_of_the_lost_worker_ends(
    call, leg_file, tmp_path, lost_claim, use_workers, records_in
):
    """A killed process holds its claim for a moment more, on a busy machine for longer."""
    waited = lost_claim("batch")
    use_workers(DeadThread())

    status, _, err = call("convert", leg_file, "--output-folder", tmp_path / "out")

    assert (status, len(waited)) == (2, 2)
    assert "leg.bvh: its process crashed" in err
    assert "its process crashed" in records_in(tmp_path / "out")["leg.bvh"]["error"]
