"""Workers end with the process that started them, and have the requested threads."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from process_checks import children_of, wait_until_gone

from solvers.processes.threads import VARIABLES
from solvers.processes.workers import worker_pool

ROOT = Path(__file__).parents[3]
POOL = """
import os, time
from solvers.processes.workers import worker_pool

if __name__ == "__main__":
    with worker_pool(2) as pool:
        idle = pool.submit(os.getpid).result()
        busy = [pool.submit(time.sleep, 10_000) for _ in range({n_tasks})]
        print(idle, flush=True)
        busy[0].result()
"""

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")


@pytest.mark.parametrize("n_tasks", [1, 3])
def test_workers_end_when_their_parent_is_killed(tmp_path, n_tasks):
    """Idle ones too, which wait for work, and those in the middle of some."""
    script = tmp_path / "pool.py"
    script.write_text(POOL.format(n_tasks=n_tasks))
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    with subprocess.Popen(
        [sys.executable, script], stdout=subprocess.PIPE, env=environment
    ) as parent:
        assert int(parent.stdout.readline())
        started = children_of(parent.pid)
        parent.kill()

    assert len(started) >= 2
    assert not wait_until_gone(started)


@pytest.mark.parametrize("verb", ["denoise", "index"])
def test_workers_of_a_command_end_when_it_is_killed(verb, swinging_leg, tmp_path):
    from solvers.recordings import write_bvh

    for number in range(20):
        write_bvh(swinging_leg, tmp_path / f"{number:02}.bvh")
    inputs = {
        "denoise": [tmp_path, "--output-folder", tmp_path / "out"],
        "index": [tmp_path / "a.clips", tmp_path],
    }
    words = [sys.executable, "-m", "solvers", verb, *inputs[verb], "--jobs", "2"]
    with subprocess.Popen(words, cwd=ROOT, stdout=subprocess.PIPE) as parent:
        started = set()
        while len(started) < 3 and parent.poll() is None:  # two workers and their tracker
            started |= children_of(parent.pid)
        parent.kill()

    assert len(started) == 3
    assert not wait_until_gone(started)


def test_workers_have_one_thread_when_the_environment_sets_more(monkeypatch):
    for name in VARIABLES:
        monkeypatch.setenv(name, "4")
    monkeypatch.delenv(VARIABLES[0])

    with worker_pool(1) as pool:
        given = [pool.submit(os.getenv, name).result() for name in VARIABLES]

    assert given == ["1"] * len(VARIABLES)
    assert [os.getenv(name) for name in VARIABLES] == [None, *["4"] * (len(VARIABLES) - 1)]


def test_workers_have_more_threads_when_they_are_requested():
    with worker_pool(1, n_threads=3) as pool:
        assert pool.submit(os.getenv, VARIABLES[0]).result() == "3"
