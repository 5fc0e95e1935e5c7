"""How long Retarget takes in Blender, and Blender's own baking of the same controls.

    make bench-retarget-rig
    make bench-retarget-rig ARGUMENTS="--frames 2000 --baked 50"
    make bench-retarget-rig ARGUMENTS=--docs    # into docs/benchmarks/retargeting.md

A walk is given to a rig of Mixamo's bones and to Rigify's human. Off: how far feet and hands
of the rig, as Blender evaluates it, are from where the solver wants them. The peer is
`bpy.ops.nla.bake` with visual keying, of the same controls: what an animator uses to bring a
motion onto a control rig with constraints; it is measured on fewer frames.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from time import perf_counter
from typing import Any

import bpy
import numpy as np
from mathutils import Vector

from solvers.motion import find_humanoid_map
from solvers.recordings import write_bvh
from solvers.retargeting import retarget as given_to
from solvers.samples import GaitSettings, walking_gait
from tests.fixtures.rigs import with_all_fingers

from ..importing.bench_scene_io import load_checkout
from ..shared.report import DOCS, Report
from ..shared.tables import table

RATE_HZ = 60.0
LOOKED_AT = 20  # frames at which the evaluated rig is compared


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--frames", type=int, default=10_000)
    parser.add_argument("--baked", type=int, default=200, help="frames that Blender bakes")
    parser.add_argument("--docs", action="store_true", help="rewrite the document")
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    sys.modules["mocap_ext"].register()
    source = import_walk(arguments.frames)
    rows, per_frame = {}, {}
    for name, target in (
        ("Mixamo's bones", make_mixamo()),
        ("Rigify, FK", hero := make_rigify()),
        ("Rigify, FK and IK", hero),
    ):
        limbs = "BOTH" if "IK" in name else "FK"
        seconds, off = retarget(source, target, limbs)
        per_frame[name] = seconds / arguments.frames
        n_bones = len(keyed_bones(target.animation_data.action))
        rows[name] = row(len(target.data.bones), n_bones, arguments.frames, seconds, off)
        if target == hero:
            baked = bake(hero, arguments.baked)
            per_frame[f"{name}, nla.bake"] = baked / arguments.baked
            rows[f"{name}: `nla.bake`, visual keying"] = row(
                len(target.data.bones), n_bones, arguments.baked, baked, None
            )
            times = per_frame[f"{name}, nla.bake"] / per_frame[name]
            rows[f"{name}: times faster"] = ["", "", "", "", f"{times:.0f}", ""]
    header = ["target", "bones", "keyed", "frames", "seconds", "ms per frame", "off, cm"]
    title = f"Blender {bpy.app.version_string}, a walk at {RATE_HZ:g} Hz"
    text = f"**{title}**\n\n{table(header, rows)}\n"
    report = Report(arguments.docs, DOCS / "benchmarks" / "retargeting.md")
    report.part("retarget rig", [text], perf_counter() - started)


def row(n_bones: int, keyed: int, n_frames: int, seconds: float, off: Any) -> list[str]:
    shown = "" if off is None else f"{100 * off:.2f}"
    return [
        str(n_bones), str(keyed), str(n_frames), f"{seconds:.1f}",
        f"{1000 * seconds / n_frames:.2f}", shown,
    ]  # fmt: skip


def import_walk(n_frames: int) -> bpy.types.Object:
    walk = walking_gait(GaitSettings(duration=n_frames / RATE_HZ, frame_rate=RATE_HZ))
    skeleton = with_all_fingers()
    roles = find_humanoid_map(skeleton)
    walk = given_to(walk, find_humanoid_map(walk.skeleton), skeleton, roles)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.bvh"
        write_bvh(walk, path)
        bpy.ops.import_anim.bvh(filepath=str(path), global_scale=0.01, update_scene_fps=True)
    return bpy.context.object


def make_mixamo() -> bpy.types.Object:
    """Make an armature of Mixamo's bones that is larger and has other bone rolls."""
    skeleton = with_all_fingers()
    armature = bpy.data.objects.new("Mixamo", bpy.data.armatures.new("Mixamo"))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for joint, name in enumerate(skeleton.names):
        bone = armature.data.edit_bones.new(name)
        bone.head = 1.2 * skeleton.rest_positions[joint]
        bone.tail = bone.head + Vector((0.01, 0.02, 0.05))
        bone.roll = 0.4
        if skeleton.parents[joint] >= 0:
            bone.parent = armature.data.edit_bones[skeleton.names[skeleton.parents[joint]]]
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def make_rigify() -> bpy.types.Object:
    import addon_utils  # which Blender has to have made importable first

    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_human_metarig_add()
    meta = bpy.context.object
    bpy.ops.pose.rigify_generate()
    hero = bpy.context.view_layer.objects.active
    bpy.data.objects.remove(meta)
    hero.name = "Hero"
    return hero


def retarget(
    source: bpy.types.Object, target: bpy.types.Object, limbs: str
) -> tuple[float, float]:
    """Press the button; return the seconds, and how far feet and hands are off, meters."""
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = source
    start = perf_counter()
    bpy.ops.mocap_assist.retarget(target=target.name, limbs=limbs)
    seconds = perf_counter() - start
    return seconds, off(source, target)


def off(source: bpy.types.Object, target: bpy.types.Object) -> float:
    """Compare the evaluated rig with the solver's result."""
    from mocap_ext.mocap_assist.retarget.button_settings import RetargetBundle, RetargetChoices
    from mocap_ext.mocap_assist.retarget.scene_retargeting import read_retarget
    from mocap_ext.solvers import retargeting
    from mocap_ext.solvers.motion import forward_kinematics

    chosen = RetargetBundle(RetargetChoices(target=target.name), retargeting.RetargetSettings())
    problem = read_retarget(bpy.context.scene, source, chosen).args[0]
    rig, motion = problem.target, problem.clips[0].on_stage()
    poses = forward_kinematics(
        retargeting.retarget(motion, problem.roles, rig.skeleton, rig.humanoid)
    )
    names = [rig.humanoid.joints[f"{side}{end}"] for side in ("left", "right")
             for end in ("Foot", "Hand")]  # fmt: skip
    frames = np.linspace(0, motion.n_frames - 1, LOOKED_AT).astype(int)
    return max(
        float(np.linalg.norm(there - poses.positions[frame, rig.skeleton.names.index(name)]))
        for frame in frames.tolist()
        for name, there in zip(names, bone_heads(target, frame + 1, names), strict=True)
    )


def bone_heads(
    armature: bpy.types.Object, frame: int, names: Sequence[str]
) -> list[np.ndarray]:
    bpy.context.scene.frame_set(frame)
    bones = armature.pose.bones
    return [np.array(armature.matrix_world @ bones[name].head) for name in names]


def keyed_bones(action: bpy.types.Action) -> set[str]:
    bag = action.layers[0].strips[0].channelbags[0]
    return {
        curve.data_path.split('"')[1] for curve in bag.fcurves if "][" not in curve.data_path
    }


def bake(armature: bpy.types.Object, n_frames: int) -> float:
    """Let Blender key the same controls as they look; return the seconds."""
    from mocap_ext.mocap_assist.blender.compat import select_bone

    keyed = keyed_bones(armature.animation_data.action)
    bpy.context.view_layer.objects.active = armature
    armature.select_set(True)
    bpy.ops.object.mode_set(mode="POSE")
    for bone in armature.pose.bones:
        select_bone(bone, bone.name in keyed)
    start = perf_counter()
    bpy.ops.nla.bake(
        frame_start=1, frame_end=n_frames, only_selected=True, visual_keying=True,
        use_current_action=False, bake_types={"POSE"},
    )  # fmt: skip
    seconds = perf_counter() - start
    bpy.ops.object.mode_set(mode="OBJECT")
    return seconds


if __name__ == "__main__":
    main()
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
