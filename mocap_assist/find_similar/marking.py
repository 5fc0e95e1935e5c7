"""An action as an asset, with tags, a catalog and a thumbnail."""

from collections.abc import Iterable
from pathlib import Path

import bpy
import numpy as np

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ...solvers.motion.humanoid import normalize_postures, postures_from_motion
from ..actions.armature_read import read_take
from ..blender.stored_json import load_json
from ..library.catalogs import catalog_file, ensure_catalog
from ..library.thumbnails import thumbnail
from ..runtime.selection import played_source, selected_armature
from .loading import CLIP
from .previews import give_picture


def why_not_mark(context: bpy.types.Context) -> str:
    """Return why nothing can become an asset, or an empty text."""
    armature = selected_armature(context)
    if armature is None:
        return "Select an armature with an action."
    try:
        action, _ = played_source(armature)
    except InvalidMotionError as error:
        return str(error)
    if action.library is not None:
        return f"{action.name} is linked; mark it in its own file."
    return ""


def mark_played(context: bpy.types.Context, tags: str, catalog: str) -> str:
    """Let the action that the armature plays be an asset; return a sentence about it.

    Tags of the clip that it was made of come along.

    Raises
    ------
    InvalidFileError
        A catalog was named, and the file was never saved or its folder cannot be written.
    """
    armature = selected_armature(context)
    action, slot = played_source(armature)
    mark_as_asset(action, [*clip_tags(action), *tags.split(",")], catalog_number(catalog))
    pictured = _picture(armature, action, slot, context.scene)
    if pictured:
        return f"{action.name} is an asset."
    return f"{action.name} is an asset, without a preview image."


def mark_as_asset(action: bpy.types.Action, tags: Iterable[str], number: str) -> None:
    """Let an action be an asset, with tags and in the catalog of that number, if any."""
    action.asset_mark()
    for tag in tags:
        if tag.strip():
            action.asset_data.tags.new(tag.strip(), skip_if_exists=True)
    if number:
        action.asset_data.catalog_id = number


def clip_tags(action: bpy.types.Action) -> list[str]:
    """Return the tags of the clip that an action was made of."""
    tags = load_json(action, CLIP, dict).get("tags", [])
    return [str(tag) for tag in tags] if isinstance(tags, list) else []


def catalog_number(catalog: str) -> str:
    """Return the number of a catalog next to the open file, which is made; empty for none.

    Raises
    ------
    InvalidFileError
        The file was never saved, or its folder cannot be written.
    """
    if not catalog.strip():
        return ""
    if not bpy.data.filepath:
        raise InvalidFileError("Save the file first: its catalogs are stored next to it.")
    return ensure_catalog(catalog_file(Path(bpy.data.filepath).parent), catalog)


def _picture(
    armature: bpy.types.Object,
    action: bpy.types.Action,
    slot: bpy.types.ActionSlot,
    scene: bpy.types.Scene,
) -> bool:
    """Give the action a preview of its body, if it has one."""
    motion = read_take(armature, scene, source=(action, slot)).parts[0].motion
    try:
        body = normalize_postures(postures_from_motion(motion), motion.frame_rate)
    except InvalidMotionError:
        return False
    reach = np.nanmax(np.linalg.norm(body.postures, axis=-1))
    give_picture(action, thumbnail(body.postures / max(float(reach), 1e-6)))
    return True
