"""How long a press takes from click to result, with and without a solver that waits.

    make bench-press
    make bench-press ARGUMENTS=--docs    # into docs/benchmarks/press.md

Blender as a Python module presses the buttons; the empty press starts a process that does
nothing. Presses alternate, so that other work on the machine meets both. Times are medians.
"""

import argparse
import os
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter, sleep

import bpy

from ..importing.bench_scene_io import load_checkout
from ..shared.report import DOCS, Report
from ..shared.tables import table

REPEATS = 5
FRAME_RATE = 30.0
N_CLIPS = 300
FIND_TITLE = f"Find Similar, 300 frames, {N_CLIPS} clips"
READY_S = 0.5
"""Seconds without CPU time after which a process waits."""


class Nothing:
    """A solve that is over at once."""

    def __reduce__(self) -> tuple[Callable[..., object], tuple[str]]:
        return eval, ("lambda progress: None",)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="rewrite docs/benchmarks/press.md")
    parser.add_argument("--repeats", type=int, default=REPEATS)
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    sys.modules["mocap_ext"].register()
    rows, empty = {}, 0.0
    with TemporaryDirectory() as folder:
        find = partial(import_with_library, Path(folder))
        for name, prepare, press in (*PRESSES, (FIND_TITLE, find, find_similar)):
            prepare()
            cold, ready = map(median, times(press, arguments.repeats))
            empty = empty or cold
            cells = (cold, ready, ready / cold, ready / empty)
            rows[name] = [f"{cell:.2f}" for cell in cells]
    header = ["press", "s", "s, solver waits", "ratio", "relative to an empty press"]
    title = f"Blender {bpy.app.version_string}, median of {arguments.repeats} presses"
    report = Report(arguments.docs, DOCS / "benchmarks" / "press.md")
    report.part("press", [f"**{title}**\n\n{table(header, rows)}\n"], perf_counter() - started)


def times(press: Callable[[], None], repeats: int) -> tuple[list[float], list[float]]:
    """Return the seconds of presses without and with a solver that waits, in turns."""
    from mocap_ext.mocap_assist.jobs import waiting_child
    from mocap_ext.mocap_assist.runtime import redo

    cold, ready = [], []
    press()  # What Blender itself loads at the first press is not of the solver.
    for _ in range(repeats):
        for found, waits in ((cold, False), (ready, True)):
            waiting_child.end_waiting()
            if waits:
                waiting_child.keep_waiting()
                wait_until_idle(waiting_child._waiting[0].process.pid)
            redo._last.clear()  # An equal press would not be solved again.
            start = perf_counter()
            press()
            found.append(perf_counter() - start)
    return cold, ready


def press_nothing() -> None:
    """Run a solve that does nothing, as buttons do."""
    from mocap_ext.mocap_assist.jobs.job import run

    run(Nothing())


def clean() -> None:
    """Press Clean."""
    assert bpy.ops.mocap_assist.denoise() == {"FINISHED"}


def check() -> None:
    """Press Check."""
    assert bpy.ops.mocap_assist.measure_quality() == {"FINISHED"}


def find_similar() -> None:
    """Press Find Similar."""
    assert bpy.ops.mocap_assist.find_similar() == {"FINISHED"}


def import_with_library(folder: Path) -> None:
    """Import a walk into a scene with a library of walks."""
    import_walk(300)
    library = folder / "walks.library"
    if not library.exists():
        index_walks(library)
    bpy.context.scene.mocap_assist.library.library_file = str(library)


def index_walks(library: Path) -> None:
    """Index walks of different speeds and cadences."""
    from mocap_ext.mocap_assist.library import solve_indexing
    from mocap_ext.solvers.recordings import write_bvh
    from mocap_ext.solvers.samples import GaitSettings, walking_gait

    clips = library.parent / "clips"
    clips.mkdir()
    for number in range(N_CLIPS):
        gait = GaitSettings(
            duration=3.0,
            frame_rate=FRAME_RATE,
            cadence=80.0 + number % 50,
            speed=0.6 + 0.08 * (number // 50),
        )
        write_bvh(walking_gait(gait), clips / f"walk_{number}.bvh")
    source = solve_indexing.Source(str(clips), False)
    blender = solve_indexing.BackgroundBlender("", "")
    solve_indexing.index_sources(
        solve_indexing.IndexProblem(str(library), (source,), (), blender)
    )


def import_walk(n_frames: int) -> None:
    """Import a noisy walk into a new scene."""
    from mocap_ext.solvers.recordings import write_bvh
    from mocap_ext.solvers.samples import (
        CorruptionSettings,
        GaitSettings,
        corrupt,
        walking_gait,
    )

    gait = GaitSettings(duration=n_frames / FRAME_RATE, frame_rate=FRAME_RATE)
    motion = corrupt(walking_gait(gait), CorruptionSettings(jitter=1.0))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "walk.bvh"
        write_bvh(motion, path)
        assert bpy.ops.mocap_assist.import_recording(filepath=str(path)) == {"FINISHED"}


PRESSES = (
    ("empty press", lambda: None, press_nothing),
    ("Clean, 300 frames, 22 bones", partial(import_walk, 300), clean),
    ("Check, 300 frames", partial(import_walk, 300), check),
    ("Clean, 3,000 frames", partial(import_walk, 3_000), clean),
    ("Check, 3,000 frames", partial(import_walk, 3_000), check),
)
"""Name, what is done before, and the press."""


def wait_until_idle(pid: int) -> None:
    """Return once a process has used no CPU time for a while."""
    former, since = -1, perf_counter()
    while perf_counter() - since < READY_S:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        used = int(fields[11]) + int(fields[12])
        if used != former or fields[0] != "S":
            former, since = used, perf_counter()
        sleep(0.05)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
