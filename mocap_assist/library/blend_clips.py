"""Read armature actions out of .blend, FBX, glTF and USD files, in a background Blender."""

from collections.abc import Sequence
from pathlib import Path

import bpy

from ...solvers.faults import Failure, attempt
from ...solvers.files import path_fault
from ...solvers.motion import Motion
from ...solvers.progress import Progress, unwatched
from ..actions.armature_read import read_take
from ..actions.fitting import fitting_slots, plays
from ..blender import compat
from ..blender.compat import Source
from ..blender.scene_files import open_scene_file
from ..jobs.in_blender import BlendClip, BlendRead, is_scene_file
from ..rigs.evaluated_body import body_bones, with_body_shown
from ..rigs.rigify import is_rigify
from ..rigs.target_read import find_roles
from ..scene import history
from ..scene.rig import END
from .catalogs import NONE, catalog_file, read_catalogs

NAME_ONE = "name a file with its rig, or index the file that has both."


def read_files(
    paths: Sequence[str],
    assets_only: bool,
    items: Sequence[str],
    rig: str = "",
    *,
    progress: Progress = unwatched,
) -> list[BlendRead]:
    """Open each file, with its scripts and drivers off, and read its actions.

    Those whose bones no armature there has are read with one of the armatures of the file
    `rig`.
    """
    found = []
    for index, path in enumerate(paths):
        progress(index / len(paths), f"Reading {Path(path).name}")
        if sentence := path_fault(path):
            found.append(BlendRead((), (sentence,)))
            continue
        read = attempt(path, _read_file, path, assets_only, items, rig)
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

    An armature that plays the action comes first, then the one that it was made for.
    """
    armatures = [each for each in bpy.data.objects if each.type == "ARMATURE"]
    made_for = history.given_to(action)
    ranked = sorted(
        armatures, key=lambda each: (not plays(each, action), each.name != made_for)
    )
    found: dict[int, tuple[bpy.types.Object, Source]] = {}
    for armature in ranked:
        for slot in fitting_slots(armature, action):
            found.setdefault(slot.handle, (armature, (action, slot)))
    return {item_of(source, len(found)): (each, source) for each, source in found.values()}


def read_source(scene: bpy.types.Scene, armature: bpy.types.Object, source: Source) -> Motion:
    """Return how the body moves; that of a control rig as its constraints show it."""
    take = read_take(armature, scene, source=source)
    bones = armature.data.bones
    if is_rigify(bones) and armature.name in scene.objects:
        body = body_bones(find_roles(armature), bones)
        take = with_body_shown(scene, armature, take, body, source)
    return take.parts[0].motion


def _read_file(path: str, assets_only: bool, items: Sequence[str], rig: str) -> BlendRead:
    open_scene_file(path)
    if is_scene_file(path):
        if sentence := _without_motion(path):
            return BlendRead((), (sentence,))
        _mark_invented_tails()
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
        found = _read_action(path, action, items)
        clips += found.clips
        refused += found.refused
    return BlendRead(tuple(clips), tuple(refused))


def _without_motion(path: str) -> str:
    """Say what a file of another program lacks."""
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


def _read_action(path: str, action: bpy.types.Action, items: Sequence[str]) -> BlendRead:
    clips, refused = [], []
    tags = _tags(action, path)
    for item, (armature, source) in sources_of(action).items():
        if items and item not in items:
            continue
        motion = attempt(f"{path}, {item}", read_source, bpy.context.scene, armature, source)
        if isinstance(motion, Failure):
            refused.append(motion.sentence)
        else:
            clips.append(BlendClip(item, motion, tags))
    return BlendRead(tuple(clips), tuple(refused))


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
    if number != NONE:
        catalogs = read_catalogs(catalog_file(Path(path).parent))
        tags += [catalogs[number]] if number in catalogs else []
    return tuple(dict.fromkeys(tags))
