"""How long Blender's window stands still while a button works on a long take.

    make bench-stalls
    make bench-stalls ARGUMENTS=--docs    # into docs/benchmarks/press.md

The operators' own steps run as the event loop would run them, in Blender as a Python module. A
stall is the time of one step. A solver waits, as it does while the sidebar is in use.
"""

import argparse
import os
import sys
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, perf_counter, sleep

import bpy
import numpy as np

from ..importing.bench_scene_io import load_checkout
from ..shared.report import DOCS, Report
from ..shared.tables import table
from .bench_press import wait_until_idle

N_FRAMES, N_BONES = 30_000, 60
FRAME_RATE = 60.0
MS = 1000.0


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="rewrite docs/benchmarks/press.md")
    parser.add_argument("--frames", type=int, default=N_FRAMES)
    parser.add_argument("--bones", type=int, default=N_BONES)
    parser.add_argument("--steps", action="store_true", help="print the longest steps")
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    sys.modules["mocap_ext"].register()
    import_long_walk(arguments.frames, arguments.bones)
    add_target()
    rows = {}
    for name, idname in BUTTONS.items():
        let_solver_wait()
        bpy.context.view_layer.update()  # as the window does between two presses
        steps = list(timed_steps(press(idname)))
        longest = sorted(steps, reverse=True)
        if arguments.steps:
            for duration, what in longest[:12]:
                print(f"{name:12} {MS * duration:8.1f} ms  {what}")
        durations = np.array([duration for duration, _ in steps])
        rows[name] = [
            f"{durations.sum():.2f}",
            f"{MS * durations.max():.0f}",
            f"{(durations > LONG_S).sum()}",
            longest[0][1],
        ]
    header = ["button", "s in Blender's thread", "longest stall, ms", "over 50 ms", "where"]
    title = f"{arguments.frames:,} frames, {arguments.bones} bones, {bpy.app.version_string}"
    report = Report(arguments.docs, DOCS / "benchmarks" / "press.md")
    report.part("stalls", [f"**{title}**\n\n{table(header, rows)}\n"], perf_counter() - started)


LONG_S = 0.05
BUTTONS = {
    "Clean": "denoise", "Check": "measure_quality", "Plant Feet": "plant_feet",
    "Retarget": "retarget",
}  # fmt: skip


def timed_steps(steps: Iterator[tuple[float, str]]) -> Iterator[tuple[float, str]]:
    """Yield the seconds of each step and what the status bar shows after it."""
    before = "Start"
    while True:
        start = perf_counter()
        try:
            fraction, message = next(steps)
        except StopIteration:
            yield perf_counter() - start, f"after {before}"
            return
        yield perf_counter() - start, f"after {before}, then {fraction:.2f} {message}"
        before = f"{fraction:.2f} {message}"
        if message not in ("Reading", "Writing"):
            sleep(0.05)


def press(idname: str) -> Iterator[tuple[float, str]]:
    """Return the steps of a button, with the settings of the sidebar."""
    from mocap_ext.mocap_assist.runtime.solver_operator import SolverOperator

    module = vars(sys.modules[f"mocap_ext.operators.{idname}"])
    button = next(value for name, value in module.items() if name.startswith("MOCAP_OT"))
    shown = getattr(bpy.context.scene.mocap_assist, button.settings_group)
    parts = {name: vars(button)[name] for name in ("read_scene", "write_scene")}
    made = type("Press", (SolverOperator,), {**parts, "bl_idname": button.bl_idname})()
    made.settings = partial(button.settings, shown)
    made.remember(bpy.context)
    made._started = monotonic()
    return made._perform()


def let_solver_wait() -> None:
    """Start a process that waits, as the sidebar does, and let it finish its imports."""
    from mocap_ext.mocap_assist.jobs import waiting_child

    waiting_child.keep_waiting()
    wait_until_idle(waiting_child._waiting[0].process.pid)


def import_long_walk(n_frames: int, n_bones: int) -> None:
    """Import a noisy walk with fingers into a new scene."""
    from mocap_ext.solvers.motion import Motion, Skeleton
    from mocap_ext.solvers.recordings import write_bvh
    from mocap_ext.solvers.samples import (
        CorruptionSettings,
        GaitSettings,
        corrupt,
        walking_gait,
    )

    gait = GaitSettings(duration=n_frames / FRAME_RATE, frame_rate=FRAME_RATE)
    motion = corrupt(walking_gait(gait), CorruptionSettings(jitter=1.0))
    skeleton, more = motion.skeleton, n_bones - motion.n_joints
    hand = skeleton.names.index(next(n for n in skeleton.names if "hand" in n.lower()))
    names = (*skeleton.names, *(f"finger_{number}" for number in range(more)))
    parents = (*skeleton.parents, *([hand] * more))
    offsets = np.concatenate([skeleton.offsets, np.full((more, 3), 0.03)])
    rotations = np.concatenate(
        [motion.rotations, np.repeat(motion.rotations[:, :1], more, axis=1)], axis=1
    )
    motion = Motion(
        Skeleton(names, parents, offsets), rotations, motion.root_positions, FRAME_RATE
    )
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "walk.bvh"
        write_bvh(motion, path)
        assert bpy.ops.mocap_assist.import_recording(filepath=str(path)) == {"FINISHED"}


def add_target() -> None:
    """Add another armature with the same bones, for Retarget."""
    source = bpy.context.view_layer.objects.active
    target = source.copy()
    target.data = source.data.copy()
    target.animation_data_clear()
    bpy.context.scene.collection.objects.link(target)
    bpy.context.scene.mocap_assist.retarget.target = target.name


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
