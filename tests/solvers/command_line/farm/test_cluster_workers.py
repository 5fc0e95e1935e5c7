"""What a worker of a Dask cluster lacks is one sentence, also when it joins later."""

import re
from contextlib import contextmanager

import pytest
from clusters.dask_cluster import local_cluster
from clusters.lone_workers import scheduler_and_workers

from solvers.command_line.farm import cluster as cluster_module
from solvers.command_line.farm import cluster_workers
from solvers.errors import InvalidSettingError, MocapAssistError

pytest.importorskip("distributed")


@pytest.fixture(scope="module")
def cluster():
    """The address of a cluster of two worker processes."""
    with local_cluster(2) as address:
        yield address


def test_workers_of_another_version_are_refused(cluster, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster_module, "build", lambda: "99.0.0")
    message = "A worker on .* has Mocap Assist .*, and this process 99.0.0. Install"

    with (
        pytest.raises(InvalidSettingError, match=message),
        cluster_workers(cluster, [tmp_path]),
    ):
        pytest.fail("connected")


def test_worker_of_another_version_that_joins_later_gets_no_task(
    cluster, tmp_path, monkeypatch
):
    with cluster_workers(cluster, [tmp_path]) as workers:
        with workers.open(1) as executor:
            assert executor.submit(len, workers.share((1, 2))).result() == 2
        monkeypatch.setattr(cluster_module, "build", lambda: "99.0.0")

        with (
            workers.open(1) as executor,
            pytest.raises(InvalidSettingError, match=r"and this process 99\.0\.0"),
        ):
            executor.submit(len, ()).result()


def test_worker_that_joins_later_without_the_folder_gets_no_task(cluster, tmp_path):
    with cluster_workers(cluster, [tmp_path]) as workers:
        workers._paths = [tmp_path / "library.clips"]  # As the checks at the start passed.

        with (
            workers.open(1) as executor,
            pytest.raises(InvalidSettingError, match=r"does not see .*library\.clips\. Mount"),
        ):
            executor.submit(len, ()).result()


def test_worker_without_the_output_folder_is_refused(cluster, tmp_path):
    with (
        pytest.raises(InvalidSettingError, match=r"does not see .*gone\. Mount it"),
        cluster_workers(cluster, [tmp_path, tmp_path / "gone"]),
    ):
        pytest.fail("connected")


def test_worker_without_the_package_is_refused(tmp_path):
    with (
        scheduler_and_workers(tmp_path, True, False) as address,
        workers_joined(address, 2),
        pytest.raises(InvalidSettingError) as raised,
        cluster_workers(address, [tmp_path]),
    ):
        pytest.fail("connected")

    assert re.fullmatch(
        r"The worker tcp://[\d.:]+ cannot import Mocap Assist \(No module named 'solvers'\)\."
        r" Install the same version there as here, with all that it needs\.",
        str(raised.value),
    )


def test_scheduler_and_late_worker_without_the_package(tmp_path):
    """The scheduler needs only Dask; a take that such a worker gets fails with a sentence."""
    with (
        scheduler_and_workers(tmp_path, False) as address,
        workers_joined(address, 1) as client,
    ):
        workers = cluster_module.WorkerCluster(client, address, [])  # As if it joined later.
        with (
            workers.open(1) as executor,
            pytest.raises(InvalidSettingError, match="A worker cannot import Mocap Assist"),
        ):
            executor.submit(len, workers.share((1, 2))).result(timeout=60)
    with (
        scheduler_and_workers(tmp_path / "other", True) as address,
        workers_joined(address, 1),
        cluster_workers(address, [tmp_path]) as workers,
        workers.open(1) as executor,
    ):
        assert executor.submit(len, workers.share((1, 2))).result(timeout=60) == 2


def test_failure_of_a_worker_is_one_sentence(cluster, tmp_path):
    with cluster_workers(cluster, [tmp_path]) as workers, workers.open(1) as executor:
        future = executor.submit(int, "no\nnumber")

        with pytest.raises(MocapAssistError) as raised:
            future.result()

    assert str(raised.value) == (
        "A worker cannot be used: invalid literal for int() with base 10: 'no\\nnumber'. Read"
        " its log, and restart it."
    )


@contextmanager
def workers_joined(address, n_workers):
    """Yield a client once this many workers have joined."""
    from distributed import Client

    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(n_workers, timeout=60)
        yield client
