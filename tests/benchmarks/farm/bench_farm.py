"""Batches and indexes on a Dask cluster: speed, overhead, and what a killed worker costs.

    make bench-farm
    make bench-farm ARGUMENTS=--docs    # into docs/benchmarks/farm.md

All runs clean the same made-up walks with the command line, which starts again each time. The
workers of the cluster have worked before.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from time import perf_counter, sleep

from clusters.dask_cluster import local_cluster

from solvers.recordings import write_bvh
from solvers.samples import GaitSettings, walking_gait

from ..shared.report import DOCS, Report
from ..shared.tables import table
from .part_index import measure_index

NOTING = "import sys; open(sys.argv[1], 'a').write(sys.argv[2] + chr(10))"
POLL_INTERVAL_S = 0.02


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="rewrite docs/benchmarks/farm.md")
    parser.add_argument("--takes", type=int, default=8, help="number of takes [default 8]")
    chosen = parser.parse_args()
    started = perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        texts = [_speeds(Path(folder), chosen.takes), _kill(Path(folder), chosen.takes)]
        indexing = perf_counter()
        index_texts = measure_index(Path(folder))
    report = Report(chosen.docs, DOCS / "benchmarks" / "farm.md")
    report.part("farm", texts, indexing - started)
    report.part("index", index_texts, perf_counter() - indexing)


def _speeds(folder: Path, n_takes: int) -> str:
    """Return the table of takes per minute."""
    takes = _write_takes(folder, n_takes)
    rows = {}
    for n_workers in (1, 2):
        local = _time(takes, folder / f"local{n_workers}", "--jobs", str(n_workers))
        with local_cluster(n_workers) as address:
            _time(takes, folder / f"first{n_workers}", "--cluster", address)
            on_cluster = _time(takes, folder / f"cluster{n_workers}", "--cluster", address)
        rows[str(n_workers)] = [
            f"{60 * n_takes / local:.1f}",
            f"{60 * n_takes / on_cluster:.1f}",
            f"{on_cluster - local:+.1f}",
        ]
    head = ["workers", "--jobs, takes/min", "--cluster, takes/min", "--cluster takes longer, s"]
    return f"**{n_takes} takes of 4 s at 30 Hz**\n\n{table(head, rows)}\n"


def _kill(folder: Path, n_takes: int) -> str:
    """Return the table of what is left after one of two workers is killed at work."""
    takes, out, notes = _write_takes(folder, n_takes), folder / "killed", folder / "notes"
    hook = f'{sys.executable} -c "{NOTING}" {notes} {{output}}'
    with local_cluster(2) as address:
        command = _command(takes, out, "--cluster", address, "--after", hook)
        run = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        _kill_a_holder(out)
        run.wait()
    made = Counter(Path(line).name for line in notes.read_text().splitlines())
    records = [json.loads(path.read_text()) for path in out.glob(".mocap_assist/*.json")]
    rows = {
        "takes": [str(n_takes)],
        "results": [str(len(list(out.glob("*.bvh"))))],
        "records of results": [str(sum(each["status"] == "done" for each in records))],
        "takes missing": [str(n_takes - len(made))],
        "takes made twice": [str(sum(count > 1 for count in made.values()))],
        "claims left": [str(len(list(out.rglob("*.claim"))))],
    }
    return f"**One of two workers killed at work**\n\n{table(['', 'number'], rows)}\n"


def _kill_a_holder(out: Path) -> None:
    """Kill the process of a claim once the first take is done."""
    while not list(out.glob(".mocap_assist/*.json")):
        sleep(POLL_INTERVAL_S)
    while True:
        for claim in out.glob(".mocap_assist/*.claim"):
            try:
                pid = json.loads(claim.read_text())["pid"]
            except (OSError, ValueError):
                continue
            os.kill(pid, signal.SIGKILL)
            return
        sleep(POLL_INTERVAL_S)


def _write_takes(folder: Path, n_takes: int) -> Path:
    takes = folder / "takes"
    takes.mkdir(exist_ok=True)
    first = takes / "take00.bvh"
    write_bvh(walking_gait(GaitSettings(duration=4.0, frame_rate=30.0)), first)
    for number in range(1, n_takes):
        shutil.copy(first, takes / f"take{number:02}.bvh")
    return takes


def _time(takes: Path, out: Path, *options: str) -> float:
    started = perf_counter()
    subprocess.run(_command(takes, out, *options), check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - started


def _command(takes: Path, out: Path, *options: str) -> list[str]:
    words = ["denoise", str(takes), "--output-folder", str(out), *options, "--json"]
    return [sys.executable, "-m", "solvers", *words]


if __name__ == "__main__":
    main()
