"""Clean a take with the installed extension in a Blender of its own, and show what it did.

    MOCAP_ASSIST_ZIP=dist/mocap_assist-VERSION-linux_x64.zip \
        python .ci/demo.py OUTPUT_FOLDER [CLIP.bvh]

Without a clip it is the built-in sample: a walk, damaged with jitter, spikes and an arm that is
missing for two seconds; there the true error can be measured. Leaves demo.blend and
before_after.png in the folder, and prints the figures.
"""

import os
import re
import subprocess
import sys
import tempfile
import traceback
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

PACKAGE = "bl_ext.user_default.mocap_assist"
MISSING_ARM, MISSING_FROM, MISSING_TO = "RightArm", 3.0, 5.0
# The extension's own libraries come first only from Blender's second start on.
INSTALL = """
import os, sys
import bpy
status = 1
try:
    bpy.ops.extensions.package_install_files(
        filepath=sys.argv[1], repo="user_default", enable_on_install=True)
    status = 0
finally:
    os._exit(status)
"""


class CannotShow(Exception):
    """A sentence for the person who called."""


def main(arguments: list[str], resources: str) -> None:
    """Make the demo, in a Blender whose preferences are in the folder `resources`."""
    if not 1 <= len(arguments) <= 2:
        raise CannotShow("Usage: python .ci/demo.py OUTPUT_FOLDER [CLIP.bvh]")
    folder, clip = Path(arguments[0]).resolve(), Path(arguments[-1]).resolve()
    if len(arguments) == 2 and not clip.is_file():
        raise CannotShow(f"There is no file {clip}. Give CLIP the path of a BVH file.")
    folder.mkdir(parents=True, exist_ok=True)
    bpy = start_blender(resources)
    truth = None if len(arguments) == 2 else make_sample(clip := folder / "sample.bvh")
    print(f"Blender {bpy.app.version_string} imports {clip.name}.", flush=True)
    armature = import_clip(bpy, clip)
    if truth is not None:
        lose_arm(armature)
    raw = body(bpy, armature)

    done = bpy.ops.mocap_assist.denoise()
    if done != {"FINISHED"}:
        raise CannotShow(f"The button Clean ended with {done}.")
    clean = body(bpy, armature)
    bpy.context.scene.frame_set(bpy.context.scene.frame_start)
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "demo.blend"), compress=True)

    rows = figures(raw, clean, truth)
    print()
    for name, before, after in rows:
        print(f"{name:<40}{before:>10}{after:>10}")
    draw(raw, clean, rows, folder / "before_after.png")
    print(f"\nLook at {folder / 'before_after.png'} and open {folder / 'demo.blend'}.")


def start_blender(resources: str) -> Any:
    """Install the zip, and return `bpy` with the extension switched on."""
    zipped = Path(os.environ.get("MOCAP_ASSIST_ZIP", "")).resolve()
    if not zipped.is_file():
        raise CannotShow("MOCAP_ASSIST_ZIP must name the extension's zip; see `make demo`.")
    os.environ["BLENDER_USER_RESOURCES"] = resources
    sys.path[:] = [path for path in sys.path if Path(path).resolve() != Path.cwd()]
    command = [sys.executable, "-c", INSTALL, str(zipped)]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=120, check=False, cwd=resources
    )
    if done.returncode:
        raise CannotShow(f"{zipped.name} was not installed.\n{done.stdout}{done.stderr}")
    import bpy
    from addon_utils import enable

    if not enable(PACKAGE, default_set=True):
        raise CannotShow(f"{zipped.name} was installed but cannot be switched on.")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy


def installed(module: str) -> ModuleType:
    """Import a module of the extension as Blender installed it."""
    return import_module(f"{PACKAGE}.{module}")


def make_sample(path: Path) -> Any:
    """Write the damaged walk, whose arm is still there, and return the walk as it should be."""
    samples = installed("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=8.0, frame_rate=30.0))
    wrong = samples.CorruptionSettings(jitter=3.0, spikes=0.004, root_jitter=0.004)
    installed("solvers.recordings").write_bvh(samples.corrupt(walk, wrong), path)
    return walk


def import_clip(bpy: Any, path: Path) -> Any:
    """Import a BVH file in meters with Blender's own importer; return the armature."""
    read_bvh = installed("solvers.recordings").read_bvh
    in_meters, as_written = read_bvh(path), read_bvh(path, scale=1.0)
    reach = [np.abs(motion.skeleton.offsets).sum() for motion in (in_meters, as_written)]
    bpy.ops.import_anim.bvh(
        filepath=str(path),
        global_scale=reach[0] / reach[1],
        rotate_mode="NATIVE",
        update_scene_fps=True,
        update_scene_duration=True,
    )
    return bpy.context.view_layer.objects.active


def lose_arm(armature: Any) -> None:
    """Remove the keys of one arm for two seconds, as under occlusion."""
    action, slot = armature.animation_data.action, armature.animation_data.action_slot
    hidden = armature.pose.bones[MISSING_ARM]
    names = {hidden.name, *(bone.name for bone in hidden.children_recursive)}
    rate = 30.0
    for curve in action.layers[0].strips[0].channelbag(slot).fcurves:
        if not any(f'bones["{name}"]' in curve.data_path for name in names):
            continue
        start = curve.keyframe_points[0].co.x
        for key in reversed(curve.keyframe_points):
            if MISSING_FROM <= (key.co.x - start) / rate < MISSING_TO:
                curve.keyframe_points.remove(key, fast=True)
        curve.update()


def body(bpy: Any, armature: Any) -> Any:
    """Return what the armature plays as a Motion."""
    take = installed("mocap_assist.actions.armature_read").read_take(
        armature, bpy.context.scene
    )
    return take.parts[0].motion


def figures(raw: Any, clean: Any, truth: Any) -> list[tuple[str, str, str]]:
    """Return rows of name, before, after: the quality, and the true error."""
    denoising = installed("solvers.denoising")
    contacts = installed("solvers.motion").detect_contacts(clean)
    before, after = (
        denoising.measure_quality(motion, contacts=contacts) for motion in (raw, clean)
    )
    lines = denoising.compare_quality(before, after).splitlines()
    rows = [tuple(re.split(r" {2,}", line)) for line in lines]
    if truth is not None:
        observed = raw.observed
        rows += [
            (
                "error against the truth (deg)",
                f"{angle_error(raw, truth, observed):.2f}",
                f"{angle_error(clean, truth, observed):.2f}",
            ),
            (
                "error where the arm was missing (deg)",
                "-",
                f"{angle_error(clean, truth, ~observed):.2f}",
            ),
        ]
    return rows


def angle_error(motion: Any, truth: Any, where: Any) -> float:
    """Mean angle between local rotations, degrees, of the joints that rotate."""
    rotations = installed("solvers.rotations.representations")
    names = [name for name in truth.skeleton.names if not name.endswith("_end")]
    mine = [motion.skeleton.index(name) for name in names]
    theirs = [truth.skeleton.index(name) for name in names]
    angles = rotations.angle_between(motion.rotations[:, mine], truth.rotations[:, theirs])
    return float(np.degrees(angles[where[:, mine]].mean()))


def draw(raw: Any, clean: Any, rows: list[tuple[str, str, str]], path: Path) -> None:
    """Save stick figures, the curves that changed most, and the table, as one picture."""
    pictures = installed("solvers.pictures")
    rotations = installed("solvers.rotations.representations")
    angles = rotations.angle_between(raw.rotations, clean.rotations)
    gaps, change = (~raw.observed).mean(axis=0), np.nansum(angles, axis=0)
    most = sorted(range(raw.n_joints), key=lambda joint: (-gaps[joint], -change[joint]))
    both = {"recorded": raw, "cleaned": clean}
    views = [
        pictures.draw_stick_figures(
            both, pictures.StickFigureSettings(n_figures=9, view=pictures.ViewDirection(view))
        )
        for view in ("side", "front")
    ]
    names = [raw.skeleton.names[joint] for joint in most[:4]]
    width = max(view.pixels.shape[1] for view in views)
    curves = pictures.draw_curves(both, names, pictures.CurveSettings(width=width))
    pictures.stack_pictures([*views, curves, pictures.draw_table(rows[0], rows[1:])]).save(path)


def is_sentence(error: Exception) -> bool:
    """Whether the error is meant for people: ours, the extension's, or a button's report."""
    names = {kind.__name__ for kind in type(error).__mro__}
    return bool(names & {"CannotShow", "MocapAssistError", "RuntimeError"})


if __name__ == "__main__":
    status = 1
    try:
        with tempfile.TemporaryDirectory(prefix="mocap-assist-demo-") as folder:
            main(sys.argv[1:], folder)
        status = 0
    except Exception as error:
        if is_sentence(error):
            print(f"The demo stopped: {error}", file=sys.stderr)
        else:
            traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # Blender may hang at its end once classes were registered.
