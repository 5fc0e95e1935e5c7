"""How long recordings of five minutes take to come into Blender, and how true they come back.

    make bench-import
    make bench-import ARGUMENTS=--docs    # into docs/manual/importing.md

The recordings are made: a walk of our own generator, as BVH with 120 frames a second, 25
joints at 30 Hz as a camera has them, and 41 points at 120 Hz. Blender's exporter makes an FBX
of the walk at 30 Hz. Blender's own importers read the same BVH and FBX in the same run.

Processor seconds are those of all processes. Unlike the time on the clock, other programs on
the machine hardly change them. An FBX is read in a background Blender, whose start, the same
for every file, has a row of its own and is not in the rows of the file.
"""

import argparse
import contextlib
import io
import os
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

import bpy
import numpy as np

from ..shared.report import Report
from ..shared.tables import table
from .bench_scene_io import CHECKOUT, load_checkout

REPEATS = 3
SECONDS = 300.0
N_MARKERS = 41


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=SECONDS, help="length of the takes")
    parser.add_argument("--docs", action="store_true", help="rewrite docs/manual/importing.md")
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    with TemporaryDirectory() as folder:
        takes = write_takes(Path(folder), arguments.seconds)
        rows = {file.name: measured(file) for file in takes}
        walk = takes[0]
        rows["walk.bvh, Blender's own importer"] = [*timed(lambda: blenders_own(walk)), "-"]
        walk = write_fbx(Path(folder), arguments.seconds)
        start = timed(start_background)
        rows[walk.name] = measured(walk, start)
        rows["walk.fbx, Blender's own importer"] = [*timed(lambda: blenders_own(walk)), "-"]
        rows["start of a background Blender"] = [*start, "-"]
    shown = {name: [*map(cell_text, cells)] for name, cells in rows.items()}
    header = ["recording", "seconds", "processor seconds", "read back, at most off, mm"]
    title = f"Blender {bpy.app.version_string}, takes of {arguments.seconds:g} s"
    ratio = rows["walk.fbx"][1] / rows["walk.fbx, Blender's own importer"][1]
    text = (
        f"**{title}**, fastest of {REPEATS} runs\n\n{table(header, shown)}\n\n"
        f"FBX takes {ratio:.1f} times the processor seconds of Blender's own importer.\n"
    )
    report = Report(arguments.docs, CHECKOUT / "docs" / "manual" / "importing.md")
    report.part("import", [text], perf_counter() - started)


class Seconds(NamedTuple):
    """Time on the clock, and of processors."""

    clock: float
    processor: float


def cell_text(cell: float | str) -> str:
    """Return a cell of the table."""
    return cell if isinstance(cell, str) else f"{cell:.2f}"


def write_takes(folder: Path, seconds: float) -> list[Path]:
    """Write a walk as a skeleton's motion, as joints of a camera, and as markers."""
    from mocap_ext.solvers.motion import (
        SENSOR_JOINTS,
        JointRecording,
        Sensor,
        Tracks,
        forward_kinematics,
        resample,
    )
    from mocap_ext.solvers.recordings import write_bvh, write_joints, write_trc
    from mocap_ext.solvers.samples import GaitSettings, walking_gait

    walk = walking_gait(GaitSettings(duration=seconds, frame_rate=120.0))
    write_bvh(walk, folder / "walk.bvh")
    slow = resample(walk, 30.0)
    names = SENSOR_JOINTS[Sensor.KINECT_V2]
    joint_positions = forward_kinematics(slow).positions
    joints = Tracks(
        names,
        joint_positions[:, np.resize(np.arange(joint_positions.shape[1]), len(names))],
        30.0,
    )
    write_joints(JointRecording(joints, None, Sensor.KINECT_V2), folder / "joints.csv")
    positions = forward_kinematics(walk).positions
    several = np.resize(np.arange(positions.shape[1]), N_MARKERS)
    markers = positions[:, several] + np.linspace(0.0, 0.05, N_MARKERS)[:, None]
    names = tuple(f"marker_{number}" for number in range(N_MARKERS))
    write_trc(Tracks(names, markers, 120.0), folder / "markers.trc")
    return [folder / name for name in ("walk.bvh", "joints.csv", "markers.trc")]


def write_fbx(folder: Path, seconds: float) -> Path:
    """Return an FBX of the walk at 30 Hz, made by Blender's exporter with a key per frame."""
    from mocap_ext.mocap_assist.importing.button_settings import ImportChoices
    from mocap_ext.mocap_assist.importing.importing import import_files
    from mocap_ext.solvers.recordings import write_bvh
    from mocap_ext.solvers.samples import GaitSettings, walking_gait

    walk = walking_gait(GaitSettings(duration=seconds, frame_rate=30.0))
    write_bvh(walk, folder / "slow.bvh")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    import_files(bpy.context, [folder / "slow.bvh"], ImportChoices())
    bpy.context.scene.render.fps = 30
    bpy.context.scene.frame_end = walk.n_frames
    path = folder / "walk.fbx"
    with contextlib.redirect_stdout(io.StringIO()):
        bpy.ops.export_scene.fbx(
            filepath=str(path), object_types={"ARMATURE"}, add_leaf_bones=False,
            bake_anim_use_all_actions=False, bake_anim_use_nla_strips=False,
            bake_anim_simplify_factor=0.0,
        )  # fmt: skip
    return path


def start_background() -> None:
    """Start a background Blender that reads no file."""
    from mocap_ext.mocap_assist.jobs.in_blender import BackgroundBlender, read_blends

    read_blends(BackgroundBlender(""), [])


NO_START = Seconds(0.0, 0.0)


def measured(file: Path, start: Seconds = NO_START) -> list[float | str]:
    """Return the seconds that Import takes, and the greatest error of what is read back.

    `start` is the time that does not count.
    """
    from mocap_ext.mocap_assist.importing.button_settings import ImportChoices
    from mocap_ext.mocap_assist.importing.importing import import_files

    made = []

    def run() -> None:
        os.utime(file)  # else the redo panel's memory of it would serve
        imported = import_files(bpy.context, [file], ImportChoices())
        assert not imported.failed, imported.failed
        made[:] = imported.made

    seconds = timed(run)
    clock, processor = (spent - before for spent, before in zip(seconds, start, strict=True))
    if file.suffix in {".csv", ".fbx"}:
        # Bones of constant length go where joints nearly are; an FBX has no second reader.
        return [clock, processor, "-"]
    return [clock, processor, f"{1000.0 * furthest(file, made[0]):.4f}"]


def furthest(file: Path, made: bpy.types.Object) -> float:
    """Return how far any joint or marker that is read back is from the file's, meters."""
    from mocap_ext.mocap_assist.actions.armature_read import read_take
    from mocap_ext.mocap_assist.actions.markers.take import read_markers
    from mocap_ext.solvers.motion import Motion, forward_kinematics
    from mocap_ext.solvers.recordings import read_motion_or_tracks

    if made.type == "ARMATURE":
        motion = read_take(made, bpy.context.scene).parts[0].motion
        found = dict(zip(motion.skeleton.names, positions_of(motion), strict=True))
    else:
        tracks = read_markers(made, bpy.context.scene).tracks
        found = dict(zip(tracks.names, np.moveaxis(tracks.positions, 1, 0), strict=True))
    recorded = read_motion_or_tracks(file)
    if isinstance(recorded, Motion):
        names, positions = recorded.skeleton.names, forward_kinematics(recorded).positions
    else:
        names, positions = recorded.names, recorded.positions
    shared = [index for index, name in enumerate(names) if name in found]
    errors = [
        np.linalg.norm(found[names[index]] - positions[:, index], axis=1) for index in shared
    ]
    return float(np.max(errors))


def positions_of(motion) -> np.ndarray:
    """Return places of joints, shape (n_joints, n_frames, 3), meters."""
    from mocap_ext.solvers.motion import forward_kinematics

    return np.moveaxis(forward_kinematics(motion).positions, 1, 0)


def blenders_own(file: Path) -> None:
    """Read a BVH or an FBX with Blender's own importer."""
    with contextlib.redirect_stdout(io.StringIO()):
        if file.suffix == ".fbx":
            bpy.ops.wm.fbx_import(filepath=str(file))
        else:
            bpy.ops.import_anim.bvh(
                filepath=str(file), global_scale=0.01, update_scene_fps=True
            )


def timed(run: Callable[[], object]) -> Seconds:
    """Return the least seconds of several runs, each in an empty scene."""
    times = []
    for _ in range(REPEATS):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        start, used = perf_counter(), processor_seconds()
        run()
        times.append((perf_counter() - start, processor_seconds() - used))
    return Seconds(*map(min, zip(*times, strict=True)))


def processor_seconds() -> float:
    """Return the processor time of this process and of those that it waited for."""
    return sum(os.times()[:4])


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
