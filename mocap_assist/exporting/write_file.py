"""Write a take with Blender's exporters, in a background Blender."""

from pathlib import Path
from typing import Any

import addon_utils
import bpy
import numpy as np
from mathutils import Matrix

from ...solvers.errors import InvalidFileError
from ...solvers.motion import Motion
from ...solvers.progress import Progress, within
from ...solvers.recordings import write_bvh
from ...solvers.recordings.conventions import CENTIMETER
from ...solvers.rotations import IDENTITY, inverse, multiply
from ..actions.take import skeleton_of
from ..blender import compat
from ..scene.rig import Placement, read_rig
from .file_formats import FileFormat
from .plain_armature import (
    BoneTree,
    SampledPoses,
    animate_plain_armature,
    build_plain_armature,
    exported_tree,
    is_control_rig,
    sample_poses,
)
from .solve_exporting import TAKE, ExportRequest, WrittenTake
from .stick_mesh import add_stick_mesh

FBX_OPTIONS = {
    "use_selection": True, "object_types": {"ARMATURE", "MESH"}, "add_leaf_bones": False,
    "apply_unit_scale": True, "apply_scale_options": "FBX_SCALE_NONE", "bake_anim": True,
    "bake_anim_use_all_bones": True, "bake_anim_use_nla_strips": False,
    "bake_anim_use_all_actions": False, "bake_anim_force_startend_keying": True,
    "bake_anim_step": 1.0, "bake_anim_simplify_factor": 0.0,
}  # fmt: skip
"""The scene's one animation, a key on every frame."""
GLB_OPTIONS = {
    "export_format": "GLB", "use_selection": True, "export_animations": True,
    "export_animation_mode": "ACTIONS", "export_force_sampling": True,
    "export_frame_step": 1, "export_anim_slide_to_zero": True, "export_yup": True,
    "export_optimize_animation_size": False,
}  # fmt: skip
SAMPLED, BUILT = 0.6, 0.7
"""Fractions of the work that are done then."""
NO_SCALE = "Bones that change their size keep the size of their rest pose."
NO_DRIVERS = "Drivers of the rig with Python code did not run."
NO_PROPS = "BVH holds only the body; {names} are left out."


def write_take(folder: Path, request: ExportRequest, progress: Progress) -> WrittenTake:
    """Open the .blend file of a folder and write the take next to it.

    Raises
    ------
    InvalidFileError
        Blender's exporter refuses the take.
    InvalidMotionError
        The armature is scaled unevenly or has no bones.
    """
    bpy.ops.wm.open_mainfile(
        filepath=str(folder / f"{TAKE}.blend"), load_ui=False, use_scripts=False
    )
    scene, armature = bpy.context.scene, bpy.data.objects[request.armature]
    _show(scene, armature, request)
    units = request.meters / _unit_of(request.file_format)
    is_rigify = is_control_rig(armature)
    tree = exported_tree(armature.data.bones, request.bones, is_control_rig=is_rigify)
    made = build_plain_armature(armature, tree, units)
    meshes = _bind_meshes(armature, made, request, units)
    sampling = within(progress, 0.0, SAMPLED)
    poses = sample_poses(scene, armature, request.frames, tree, units, sampling)
    notes = [NO_SCALE] * poses.scales + [NO_DRIVERS] * bool(bpy.app.autoexec_fail)
    target = folder / f"{TAKE}{request.file_format.ending}"
    if request.file_format is FileFormat.BVH:
        notes += _write_bvh(target, made, tree, poses, request, progress)
    else:
        progress(SAMPLED, "Building")
        bpy.data.objects.remove(armature)
        bpy.data.batch_remove(bpy.data.actions)  # so that the new one gets the name
        scene.unit_settings.system = "METRIC"
        scene.unit_settings.scale_length = _unit_of(request.file_format)
        animate_plain_armature(made, tree, poses, request.frames, request.action)
        progress(BUILT, "Writing")
        _write_scene(target, made, meshes, request)
    return WrittenTake(len(request.frames), len(tree.names), tuple(notes))


def _unit_of(file_format: FileFormat) -> float:
    """Return the length of one unit of the data before it is written, in meters."""
    return CENTIMETER if file_format is FileFormat.FBX else 1.0


def _write_scene(
    target: Path,
    made: bpy.types.Object,
    meshes: list[bpy.types.Object],
    request: ExportRequest,
) -> None:
    """Write the plain armature and its meshes with Blender's exporters."""
    scene = bpy.context.scene
    is_fbx = request.file_format is FileFormat.FBX
    bound = meshes or ([] if is_fbx else [add_stick_mesh(made)])
    for each in scene.objects:
        each.select_set(each in [made, *bound])
    bpy.context.view_layer.objects.active = made
    if is_fbx:
        scene.name = request.action  # which is the name of the take in the file
        _run("io_scene_fbx", bpy.ops.export_scene.fbx, FBX_OPTIONS | {"filepath": str(target)})
        return
    # Blender's exporter multiplies by the base where it should divide.
    scene.render.fps_base = 1.0 / request.fps_base
    _run("io_scene_gltf2", bpy.ops.export_scene.gltf, GLB_OPTIONS | {"filepath": str(target)})


def _show(scene: bpy.types.Scene, armature: bpy.types.Object, request: ExportRequest) -> None:
    """Let the armature play its action, and nothing else, at the rate of the scene."""
    scene.render.fps, scene.render.fps_base = request.fps, request.fps_base
    scene.frame_start, scene.frame_end = request.frames[0], request.frames[-1]
    for name in (request.armature, *request.meshes):
        scene.collection.objects.link(bpy.data.objects[name])
    animation = armature.animation_data
    for track in animation.nla_tracks:
        track.mute = True
    action = bpy.data.actions[request.action]
    slot = compat.find_slot(action, request.slot)
    if slot is not None:
        compat.assign(armature, action, slot)
    animation.action_influence, animation.action_blend_type = 1.0, "REPLACE"
    armature.data.pose_position = "POSE"
    scene.frame_set(request.frames[0])


def _bind_meshes(
    armature: bpy.types.Object, made: bpy.types.Object, request: ExportRequest, units: float
) -> list[bpy.types.Object]:
    """Let skinned meshes follow the plain armature, in its units."""
    meshes = [bpy.data.objects[name] for name in request.meshes]
    placed = [Matrix.Scale(units, 4) @ each.matrix_world for each in meshes]
    for mesh, matrix in zip(meshes, placed, strict=True):
        for modifier in mesh.modifiers:
            if modifier.type == "ARMATURE" and modifier.object == armature:
                modifier.object = made
        mesh.animation_data_clear()
        mesh.parent, mesh.matrix_parent_inverse = made, Matrix.Identity(4)
        mesh.matrix_world = matrix
    return meshes


def _write_bvh(
    target: Path,
    made: bpy.types.Object,
    tree: BoneTree,
    poses: SampledPoses,
    request: ExportRequest,
    progress: Progress,
) -> list[str]:
    """Write the tree of the body; return what is left out."""
    rig = read_rig(made)
    tops = [bone for bone, parent in enumerate(rig.parents) if parent < 0]
    largest = max(tops, key=lambda top: len(rig.subtree(top)))
    root = rig.bones.index(request.body) if request.body in rig.bones else largest
    bones = rig.subtree(root)
    order = [tree.names.index(rig.bones[bone]) for bone in bones]
    rotated = multiply(poses.rotations[:, order], inverse(rig.rest_rotations[bones]))
    parents = [bones.index(rig.parents[bone]) for bone in bones[1:]]
    local = rotated.copy()
    local[:, 1:] = multiply(inverse(rotated[:, parents]), rotated[:, 1:])
    still = Placement(IDENTITY[None], np.zeros((1, 3)), 1.0)
    skeleton, owners = skeleton_of(rig, bones, still)
    ends = np.tile(IDENTITY, (len(local), len(owners) - len(bones), 1))
    motion = Motion(
        skeleton,
        np.concatenate([local, ends], axis=1),
        poses.positions[:, order[0]],
        request.fps / request.fps_base,
    )
    write_bvh(motion, target, progress=within(progress, SAMPLED, 1.0))
    above = rig.chain_to(root)
    others = [rig.bones[top] for top in tops if top not in (root, *above)]
    return [NO_PROPS.format(names=", ".join(others))] if others else []


def _run(addon: str, operator: Any, options: dict[str, Any]) -> None:
    addon_utils.enable(addon)
    try:
        operator(**options)
    except RuntimeError as error:
        lines = str(error).strip().removeprefix("Error:").strip().splitlines()
        reason = lines[-1].rstrip(".") if lines else "no reason is given"
        raise InvalidFileError(f"Blender's exporter failed: {reason}.") from None
