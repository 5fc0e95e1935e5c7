"""Read armature actions out of .blend, FBX, glTF and USD files, in a background Blender."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np

from ...solvers.faults import Failure, attempt
from ...solvers.files import path_fault
from ...solvers.motion import FileConventions, Motion
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import is_scene_file, suffix_by_content
from ...solvers.recordings.conventions import correct_stated_unit, stand_scene_upright
from ..actions.armature_read import read_take
from ..actions.fitting import fitting_slots, plays_action, plays_slot
from ..blender import compat
from ..blender.compat import Source
from ..blender.fbx_curves import describe_missing_curves
from ..blender.scene_files import open_scene_file
from ..blender.skinned_meshes import pack_skinned_meshes
from ..blender.stated_conventions import stated_conventions
from ..jobs.in_blender import BlendClip, BlendRead, LeftOut
from ..rigs.evaluated_body import body_bones, with_body_shown
from ..rigs.rigify import is_rigify
from ..rigs.target_read import find_roles
from ..scene import history
from ..scene.rig import END
from .carriers import with_carriers
from .catalogs import NO_CATALOG, catalog_file, read_catalogs
from .left_out import find_left_out

ROUNDING = 1e-3
"""Relative error that is only rounding of lengths stored in 32 bits, after a chain of bones."""
NAME_ONE = "choose a rig file, or index the file that contains action and rig."


def read_files(
    paths: Sequence[str],
    assets_only: bool,
    items: Sequence[str],
    rig: str = "",
    *,
    meshes: bool = False,
    progress: Progress = unwatched,
) -> list[BlendRead]:
    """Open each file, with its scripts and drivers off, and read its actions.

    Those whose bones no armature there has are read with one of the armatures of the file
    `rig`. With `meshes`, skinned meshes are returned too.
    """
    found = []
    for index, path in enumerate(paths):
        progress(index / len(paths), f"Reading {Path(path).name}")
        if sentence := path_fault(path):
            found.append(BlendRead((), (sentence,)))
            continue
        read = attempt(path, _read_file, path, assets_only, items, rig, meshes)
        found.append(BlendRead((), (read.sentence,)) if isinstance(read, Failure) else read)
    return found


def actions_of(assets_only: bool) -> list[bpy.types.Action]:
    """Return the actions of the open file itself, not those that it links."""
    return [
        action
        for action in bpy.data.actions
        if action.library is None and (action.asset_data is not None or not assets_only)
    ]


def item_of(source: Source, n_slots: int) -> str:
    """Return the name by which a library knows an action in a .blend file."""
    action, slot = source
    return action.name if n_slots == 1 else f"{action.name}:{slot.name_display}"


def sources_of(action: bpy.types.Action) -> dict[str, tuple[bpy.types.Object, Source]]:
    """Return the slots of an action that move armatures, each with its armature, by item.

    Of several armatures with these bones it is the one that plays the slot, then the one that
    it was made for or is called after.
    """
    armatures = [each for each in bpy.data.objects if each.type == "ARMATURE"]
    fitting = {each: fitting_slots(each, action) for each in armatures}
    made_for = history.given_to(action)
    found = []
    for slot in action.slots:
        ranked = sorted(
            (each for each in armatures if slot in fitting[each]),
            key=lambda each, slot=slot: (  # type: ignore[misc]
                not plays_slot(each, action, slot),
                each.name != made_for,
                each.name != slot.name_display,
                not plays_action(each, action),
            ),
        )
        found += [(ranked[0], (action, slot))] if ranked else []
    return {item_of(source, len(found)): (each, source) for each, source in found}


def read_source(
    scene: bpy.types.Scene, armature: bpy.types.Object, source: Source, root: str = ""
) -> Motion:
    """Return how the body moves; that of a control rig as its constraints show it.

    `root` is the bone that the body begins with, if it is known.
    """
    take = read_take(armature, scene, source=source, root=root)
    bones = armature.data.bones
    if is_rigify(bones) and armature.name in scene.objects:
        body = body_bones(find_roles(armature), bones)
        take = with_body_shown(scene, armature, take, body, source)
    return take.parts[0].motion


def _read_clip(
    armature: bpy.types.Object, source: Source, stated: FileConventions | None, root: str = ""
) -> tuple[Motion, LeftOut]:
    """Return how a body moves, and what is left out of it.

    If another program made the file, the body moves along with the objects above its armature.
    """
    scene = bpy.context.scene
    if stated is None:
        return read_source(scene, armature, source, root), LeftOut()
    if is_rigify(armature.data.bones):
        motion = read_source(scene, armature, source, root)
        return _with_conventions(armature, motion, stated), LeftOut()
    take = read_take(armature, scene, source=source, root=root, holds_ends=True)
    motion = take.parts[0].motion
    unit = _unit_ratio(armature, motion)
    motion = with_carriers(scene, armature, source, take.frames, motion, unit)
    return _with_conventions(armature, motion, stated), find_left_out(source, take)


def _read_file(
    path: str, assets_only: bool, items: Sequence[str], rig: str, meshes: bool
) -> BlendRead:
    open_scene_file(path, meshes=meshes)
    stated = None
    if is_scene_file(path):
        if sentence := _without_motion(path):
            return BlendRead((), (sentence,), is_empty=True)
        _mark_invented_tails()
        stated = stated_conventions(path)
    actions = actions_of(assets_only)
    lack_rig = rig and any(map(_lacks_rig, actions))
    refused = _bring_armatures(rig) if lack_rig else []
    clips: list[BlendClip] = []
    for action in actions:
        if _lacks_rig(action):
            where = f"the file, nor in {rig}," if rig else "the file"
            refused.append(
                f"{path}: no armature in {where} has the bones of the action {action.name};"
                f" {NAME_ONE}"
            )
            continue
        found = _read_action(path, action, items, stated)
        clips += found.clips
        refused += found.refused
    is_empty = not (clips or refused)
    if suffix_by_content(path) == ".fbx" and (missing := describe_missing_curves(path)):
        refused.append(missing)
    if stated is not None:
        clips = _stand_upright(_with_one_root(clips, stated))
    kept = pack_skinned_meshes() if meshes else None
    return BlendRead(tuple(clips), tuple(refused), is_empty=is_empty, meshes=kept)


def _stand_upright(clips: list[BlendClip]) -> list[BlendClip]:
    """Turn all takes of a file whose bodies refute its up axis."""
    motions = stand_scene_upright([clip.motion for clip in clips])
    return [replace(clip, motion=motion) for clip, motion in zip(clips, motions, strict=True)]


def _with_one_root(clips: list[BlendClip], stated: FileConventions) -> list[BlendClip]:
    """Read takes again whose body begins higher up than in another take of its armature.

    Where the body begins is estimated from how bones travel, which differs from take to take.
    What the bones above do is part of the motion; what the hips do below a bone above them is
    not.
    """
    smallest: dict[str, Motion] = {}
    for clip in clips:
        known = smallest.setdefault(clip.armature, clip.motion)
        if clip.motion.skeleton.n_joints < known.skeleton.n_joints:
            smallest[clip.armature] = clip.motion
    sources = {
        item: found for action in bpy.data.actions for item, found in sources_of(action).items()
    }
    same = []
    for clip in clips:
        root = smallest[clip.armature].skeleton.names[0]
        if clip.motion.skeleton.names[0] != root:
            armature, source = sources[clip.item]
            motion, _ = _read_clip(armature, source, stated, root)
            clip = replace(clip, motion=motion)
        same.append(clip)
    return same


def _without_motion(path: str) -> str:
    """Return what a file of another program lacks."""
    if not any(each.type == "ARMATURE" for each in bpy.data.objects):
        return f"{path} has no skeleton, so there is no body to import."
    if not bpy.data.actions:
        return f"{path} has a skeleton but no animation; as a target rig, open it in Blender."
    return ""


def _mark_invented_tails() -> None:
    """Mark the last bone of each chain: these formats have joints, and importers add tails."""
    for armature in bpy.data.armatures:
        for bone in armature.bones:
            if not bone.children:
                bone[END] = True


def _read_action(
    path: str, action: bpy.types.Action, items: Sequence[str], stated: FileConventions | None
) -> BlendRead:
    """Read the motion of armatures by an action; `stated` is what another program's file
    says."""
    clips, refused = [], []
    tags = _tags(action, path)
    for item, (armature, source) in sources_of(action).items():
        if items and item not in items:
            continue
        read = attempt(f"{path}, {item}", _read_clip, armature, source, stated)
        if isinstance(read, Failure):
            refused.append(read.sentence)
            continue
        motion, left_out = read
        clips.append(BlendClip(item, motion, tags, armature.name, left_out))
    return BlendRead(tuple(clips), tuple(refused))


def _with_conventions(
    armature: bpy.types.Object, motion: Motion, stated: FileConventions
) -> Motion:
    """Note the axes and unit of a file of another program, as they were interpreted."""
    return correct_stated_unit(motion, stated, _unit_ratio(armature, motion))


def _unit_ratio(armature: bpy.types.Object, motion: Motion) -> float:
    """Return meters of a motion per Blender unit: not 1 where the stated unit was absurd."""
    bones, skeleton = armature.data.bones, motion.skeleton
    scale = armature.matrix_world.median_scale
    ratios = []
    for joint, parent in enumerate(skeleton.parents):
        pair = skeleton.names[joint], skeleton.names[parent]
        if parent >= 0 and all(name in bones for name in pair):
            one, other = (bones[name].head_local for name in pair)
            if length := scale * (one - other).length:
                ratios.append(float(np.linalg.norm(skeleton.offsets[joint])) / length)
    ratio = float(np.median(ratios)) if ratios else 1.0
    return 1.0 if abs(ratio - 1.0) < ROUNDING or not ratio > 0.0 else ratio


def _bring_armatures(path: str) -> list[str]:
    """Copy the armatures of another file into the open one; return what was wrong with it."""
    try:
        with bpy.data.libraries.load(path, link=False) as (there, taken):
            taken.objects = there.objects
    except OSError as error:
        return [f"{path} cannot be read for its rig: {error}"]
    for each in taken.objects:
        if each is not None and each.type == "ARMATURE":
            bpy.context.scene.collection.objects.link(each)
    bpy.context.view_layer.update()
    return []


def _lacks_rig(action: bpy.types.Action) -> bool:
    """Whether it moves bones that no armature of the open file has."""
    if sources_of(action):
        return False
    bags = [compat.channelbag(action, slot) for slot in action.slots]
    return any(
        curve.data_path.startswith("pose.bones[")
        for bag in bags
        if bag
        for curve in bag.fcurves
    )


def _tags(action: bpy.types.Action, path: str) -> tuple[str, ...]:
    """Return the tags of an asset, and the path of its catalog."""
    if action.asset_data is None:
        return ()
    tags = [tag.name for tag in action.asset_data.tags]
    number = action.asset_data.catalog_id.lower()
    if number != NO_CATALOG:
        catalogs = read_catalogs(catalog_file(Path(path).parent))
        tags += [catalogs[number]] if number in catalogs else []
    return tuple(dict.fromkeys(tags))
