"""Draw what Retarget makes of a clip on rigs of several families, as Blender evaluates them.

    PYTHONPATH=.:tests/fixtures python .ci/documents/draw_rigs.py CLIP.bvh OUTPUT_FOLDER

Above the recording, below the rig, at the same moments. Of Rigify's rig the bones are drawn
that its deform bones follow, after all constraints.
"""

import importlib.util
import os
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
FIGURES = 7


def main(clip: Path, folder: Path) -> None:
    """Draw each rig."""
    import bpy

    extension = load_extension(bpy)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in {
        "rigify": make_rigify,
        "mixamo": make_mixamo,
        "unreal": make_unreal,
    }.items():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        target = make(bpy)
        bpy.ops.import_anim.bvh(filepath=str(clip), update_scene_fps=True)
        source = bpy.context.object
        bpy.ops.mocap_assist.retarget(target=target.name)
        draw(bpy, extension, source, target, folder / f"{name}.png")


def load_extension(bpy: ModuleType) -> str:
    """Register the checkout as one package; return its name."""
    name = "mocap_ext"
    spec = importlib.util.spec_from_file_location(
        name, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    assert spec is not None and spec.loader is not None
    sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[name])
    sys.modules[name].register()
    return name


def draw(bpy: ModuleType, extension: str, source: Any, target: Any, path: Path) -> None:
    """Draw source and target side by side at the same moments."""
    from mocap_ext.mocap_assist.retarget import button_settings, retargeting
    from mocap_ext.solvers.motion import Motion, local_rotations
    from mocap_ext.solvers.pictures import (
        StickFigureSettings,
        draw_stick_figures,
        stack_pictures,
    )
    from mocap_ext.solvers.retargeting import RetargetSettings
    from mocap_ext.solvers.rotations.representations import quaternion_from_matrix

    chosen = button_settings.RetargetBundle(
        button_settings.RetargetChoices(target=target.name), RetargetSettings()
    )
    problem = retargeting.read_retarget(bpy.context.scene, source, chosen).args[0]
    theirs, skeleton = problem.clips[0].motion, problem.target.skeleton
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (theirs.n_frames, skeleton.n_joints, 1))
    positions = np.zeros((theirs.n_frames, 3))
    for frame in range(theirs.n_frames):
        bpy.context.scene.frame_set(frame + 1)
        for joint, name in enumerate(skeleton.names):
            bone = target.pose.bones.get(name)
            if bone is None:
                rotations[frame, joint] = rotations[frame, skeleton.parents[joint]]
                continue
            moved = (
                target.matrix_world
                @ bone.matrix
                @ (target.matrix_world @ bone.bone.matrix_local).inverted()
            )
            rotations[frame, joint] = quaternion_from_matrix(
                np.array(moved.to_quaternion().to_matrix())
            )
            if joint == 0:
                positions[frame] = np.array(target.matrix_world @ bone.head)
    ours = Motion(skeleton, local_rotations(skeleton, rotations), positions, theirs.frame_rate)
    settings = StickFigureSettings(n_figures=FIGURES)
    pictures = [
        draw_stick_figures({label: motion}, settings)
        for label, motion in (
            ("recording", theirs),
            (path.stem.capitalize(), ours),
        )
    ]
    stack_pictures(pictures).save(path)


def make_rigify(bpy: ModuleType) -> Any:
    """Generate Rigify's human."""
    import addon_utils

    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_human_metarig_add()
    meta = bpy.context.object
    bpy.ops.pose.rigify_generate()
    bpy.data.objects.remove(meta)
    return bpy.context.view_layer.objects.active or bpy.data.objects["rig"]


def make_mixamo(bpy: ModuleType) -> Any:
    """Make an armature of Mixamo's bones, larger than life."""
    from rigs import mixamo

    return make_armature(bpy, "Mixamo", mixamo(1.2))


def make_unreal(bpy: ModuleType) -> Any:
    """Make an armature of Unreal's bones in an A-pose."""
    from rigs import unreal

    return make_armature(bpy, "Unreal", unreal())


def make_armature(bpy: ModuleType, name: str, skeleton: Any) -> Any:
    """Make an armature whose bones all point in the same unusual direction."""
    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    bpy.context.scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for joint, bone_name in enumerate(skeleton.names):
        bone = armature.data.edit_bones.new(bone_name)
        bone.head = skeleton.rest_positions[joint]
        bone.tail = skeleton.rest_positions[joint] + np.array([0.02, 0.03, 0.05])
        if skeleton.parents[joint] >= 0:
            bone.parent = armature.data.edit_bones[skeleton.names[skeleton.parents[joint]]]
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve())
    sys.stdout.flush()
    os._exit(0)  # Blender may hang at its end
