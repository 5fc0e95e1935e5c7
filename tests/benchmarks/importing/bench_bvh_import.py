"""Reading BVH: ours against Blender's own importer and against plain Python.

    make bench-bvh
    make bench-bvh ARGUMENTS=--docs    # into docs/benchmarks/importing.md

30 joints x 5000 frames. Ours reads, checks, turns every angle into a quaternion and checks
again. Blender's importer also makes an armature and its F-curves. Plain Python only turns the
words of the MOTION part into numbers, line by line.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np

from solvers.motion import Motion, Skeleton
from solvers.recordings import read_bvh, write_bvh
from solvers.rotations.representations import quaternion_from_rotation_vector

from ..shared.report import DOCS, Report
from ..shared.tables import table
from ..shared.timing import run_times

N_JOINTS, N_FRAMES = 30, 5000
REPEATS = 5
TIMEOUT = 300.0
IN_BLENDER = "--in-blender"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/importing.md"
    )
    chosen = parser.parse_args()
    started = perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "take.bvh"
        write_bvh(_take(), path)
        seconds = {
            "ours (read_bvh)": median(run_times(lambda: read_bvh(path), REPEATS)),
            "plain float() per number": median(run_times(lambda: _plain(path), REPEATS)),
            "Blender's importer": _blender(path),
        }
        size = path.stat().st_size / 1e6
    ours = seconds["ours (read_bvh)"]
    title = f"{N_JOINTS} joints x {N_FRAMES} frames, {size:.1f} MB, median of {REPEATS} runs"
    rows = {
        name: ["-", "-"] if time is None else [f"{time:.3f}", f"{time / ours:.1f}"]
        for name, time in seconds.items()
    }
    text = f"**{title}**\n\n{table(['reader', 'seconds', 'times ours'], rows)}\n"
    report = Report(chosen.docs, DOCS / "benchmarks" / "importing.md")
    report.part("bvh", [text], perf_counter() - started)


def _take() -> Motion:
    """A body of chains of five joints that sway."""
    names = tuple(f"joint_{number}" for number in range(N_JOINTS))
    parents = tuple(-1 if not n else (0 if n % 5 == 1 else n - 1) for n in range(N_JOINTS))
    skeleton = Skeleton(names, parents, np.tile([0.05, 0.02, 0.25], (N_JOINTS, 1)))
    time = np.arange(N_FRAMES)[:, None, None] / 120.0
    phases = np.random.default_rng(1).uniform(0, 6.28, size=(N_JOINTS, 3))
    rotations = quaternion_from_rotation_vector(0.4 * np.sin(time * (1 + phases) + phases))
    return Motion(skeleton, rotations, np.tile([0.0, 0.0, 1.0], (N_FRAMES, 1)), 120.0)


def _plain(path: Path) -> list[list[float]]:
    with path.open(encoding="utf-8") as file:
        for line in file:
            if line.startswith("Frame Time"):
                break
        return [[float(word) for word in line.split()] for line in file]


def _blender(path: Path) -> float | None:
    """Return the median time of the importer in a process of its own; None without bpy."""
    command = [
        sys.executable,
        "-m",
        "tests.benchmarks.importing.bench_bvh_import",
        IN_BLENDER,
        str(path),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
    lines = [line for line in done.stdout.splitlines() if line.startswith("[")]
    return median(json.loads(lines[-1])) if lines else None


def _import_in_blender(path: str) -> None:
    import bpy

    times = []
    for _ in range(REPEATS):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        started = perf_counter()
        bpy.ops.import_anim.bvh(filepath=path)
        times.append(perf_counter() - started)
    print(json.dumps(times), flush=True)
    os._exit(0)  # bpy may hang when the interpreter closes.


if __name__ == "__main__":
    if IN_BLENDER in sys.argv:
        _import_in_blender(sys.argv[-1])
    else:
        main()
