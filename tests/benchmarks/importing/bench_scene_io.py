"""How long Mocap Assist takes to read and write an action of 120 bones x 10,000 frames.

    make bench-scene
    make bench-scene ARGUMENTS="--bones 60 --mode XYZ"
    make bench-scene ARGUMENTS=--docs    # into docs/benchmarks/importing.md

Next to it, in the same run and on the same curves, the fastest bare way that Blender's API
offers (`foreach_get`, `foreach_set`, no meaning attached). Each time is the median of three.
"""

import argparse
import importlib.util
import os
import sys
from pathlib import Path
from statistics import median
from time import perf_counter

import bpy
import numpy as np

from ..shared.report import DOCS, Report
from ..shared.tables import table
from ..shared.timing import run_times

CHECKOUT = Path(__file__).resolve().parents[3]
REPEATS = 3


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bones", type=int, default=120)
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--mode", default="QUATERNION", help="rotation mode of the bones")
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/importing.md"
    )
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    from mocap_ext.mocap_assist.actions import armature_read, armature_write

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    armature = make_chain(arguments.bones, arguments.mode)
    curves = animate(armature, arguments.frames)
    take = armature_read.read_take(armature, bpy.context.scene)
    source = armature_read.action_of(armature)

    def write() -> None:
        made, _ = armature_write.write_take(armature, source, take, take.rig.bones, {})
        bpy.data.actions.remove(made)

    work = {
        "read: bare keys of all curves": lambda: bare_read(curves),
        "read: a take": lambda: armature_read.read_take(armature, bpy.context.scene),
        "write: bare new curves": lambda: bare_write(len(curves), arguments.frames),
        "write: a take into a new action": write,
    }
    keys = len(curves) * arguments.frames
    title = (
        f"Blender {bpy.app.version_string}, {arguments.bones} bones, {arguments.mode},"
        f" {arguments.frames} frames, {len(curves)} curves, {keys / 1e6:.1f} million keys"
    )
    rows, bare = {}, 0.0
    for name, run in work.items():
        seconds = median(run_times(run, REPEATS))
        bare = seconds if "bare" in name else bare
        rows[name] = [f"{seconds:.2f}", f"{1e6 * seconds / keys:.2f}", f"{seconds / bare:.1f}"]
    header = ["what", "seconds", "microseconds per key", "relative to a bare loop"]
    text = f"**{title}**, median of {REPEATS} runs\n\n{table(header, rows)}\n"
    report = Report(arguments.docs, DOCS / "benchmarks" / "importing.md")
    report.part("scene", [text], perf_counter() - started)


def bare_read(curves: list[bpy.types.FCurve]) -> None:
    for curve in curves:
        keys = np.empty(2 * len(curve.keyframe_points), np.float32)
        curve.keyframe_points.foreach_get("co", keys)


def bare_write(n_curves: int, n_frames: int) -> None:
    made = bpy.data.actions.new("bare")
    slot = made.slots.new("OBJECT", "bare")
    bag = made.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)
    keys = np.zeros((n_frames, 2), np.float32)
    keys[:, 0] = np.arange(1, n_frames + 1)
    for index in range(n_curves):
        curve = bag.fcurves.new("bare", index=index)
        curve.keyframe_points.add(n_frames)
        curve.keyframe_points.foreach_set("co", keys.ravel())
        curve.keyframe_points.foreach_set("interpolation", np.ones(n_frames, np.uint8))
        curve.update()
    bpy.data.actions.remove(made)


def make_chain(n_bones: int, mode: str) -> bpy.types.Object:
    """Make an armature of five chains that hang on one root."""
    armature = bpy.data.objects.new("Actor", bpy.data.armatures.new("Actor"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    for index in range(n_bones):
        bone = bones.new(f"bone{index}")
        bone.parent = bones[max(index - 5, 0)] if index else None
        bone.head, bone.tail = (
            (index % 5, 0, 1 + 0.1 * index),
            (index % 5, 0, 1.1 + 0.1 * index),
        )
    bpy.ops.object.mode_set(mode="OBJECT")
    for bone in armature.pose.bones:
        bone.rotation_mode = mode
    return armature


def animate(armature: bpy.types.Object, n_frames: int) -> list[bpy.types.FCurve]:
    """Key rotation and location of every bone on every frame."""
    action = bpy.data.actions.new("take")
    slot = action.slots.new("OBJECT", armature.name)
    bag = action.layers.new("Layer").strips.new(type="KEYFRAME").channelbag(slot, ensure=True)
    quaternion = armature.pose.bones[0].rotation_mode == "QUATERNION"
    rotation = ("rotation_quaternion", 4) if quaternion else ("rotation_euler", 3)
    keys = np.empty((n_frames, 2), np.float32)
    keys[:, 0] = np.arange(1, n_frames + 1)
    for number, bone in enumerate(armature.pose.bones):
        for name, width in (rotation, ("location", 3)):
            for index in range(width):
                curve = bag.fcurves.new(f'pose.bones["{bone.name}"].{name}', index=index)
                keys[:, 1] = 0.3 * np.sin(0.02 * keys[:, 0] + number + index)
                curve.keyframe_points.add(n_frames)
                curve.keyframe_points.foreach_set("co", keys.ravel())
                curve.update()
    armature.animation_data_create().action = action
    armature.animation_data.action_slot = slot
    return list(bag.fcurves)


def load_checkout() -> None:
    """Make the checkout importable as an extension is: as one package with the three layers."""
    spec = importlib.util.spec_from_file_location(
        "mocap_ext", CHECKOUT / "__init__.py", submodule_search_locations=[str(CHECKOUT)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules["mocap_ext"] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
