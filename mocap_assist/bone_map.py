"""Which bones of source and target play which part: found, edited, or from a preset."""

import json
from pathlib import Path
from typing import NamedTuple

import bpy

from ..solvers.errors import InvalidFileError
from ..solvers.files import written_whole
from ..solvers.motion import HUMANOID_ROLES, HumanoidMap
from .scene.target_read import find_target_map


class BoneMaps(NamedTuple):
    """Names of bones by role, of both armatures."""

    source: HumanoidMap
    target: HumanoidMap


def find_maps(source: bpy.types.Object, target: bpy.types.Object) -> BoneMaps:
    """Find out by names and structure which bones play which part."""
    return BoneMaps(find_target_map(source), find_target_map(target))


def maps_for(
    scene: bpy.types.Scene,
    source: bpy.types.Object,
    target: bpy.types.Object,
    map_file: str = "",
) -> BoneMaps:
    """Return the maps of a preset, or of the list if it is of these armatures; or find them."""
    if map_file:
        return read_maps(Path(bpy.path.abspath(map_file)))
    listed = scene.mocap_assist.bone_map
    if (listed.source, listed.target) == (source.name, target.name) and len(listed.rows):
        return listed_maps(listed)
    return find_maps(source, target)


def listed_maps(listed: bpy.types.PropertyGroup) -> BoneMaps:
    """Return what the list of bones says; a bone that is named twice counts once."""
    maps = []
    for side in ("source", "target"):
        roles: dict[str, str] = {}
        for row in listed.rows:
            bone = getattr(row, side)
            if bone and row.name in HUMANOID_ROLES and bone not in roles.values():
                roles[row.name] = bone
        maps.append(HumanoidMap(roles, getattr(listed, f"{side}_score")))
    return BoneMaps(*maps)


def list_maps(
    listed: bpy.types.PropertyGroup,
    source: bpy.types.Object,
    target: bpy.types.Object,
    maps: BoneMaps,
) -> None:
    """Show maps in the list of bones: a row for each role that either armature may play."""
    listed.source, listed.target = source.name, target.name
    listed.source_score, listed.target_score = (each.score for each in maps)
    listed.rows.clear()
    played = {role for each in maps for role in each.joints}
    body = [role for role in HUMANOID_ROLES if not is_finger(role)]
    for role in (*body, *(each for each in HUMANOID_ROLES if each not in body)):
        if role in played or not is_finger(role):
            row = listed.rows.add()
            row.name = role
            row.source = maps.source.joint(role) or ""
            row.target = maps.target.joint(role) or ""


def write_maps(path: Path, maps: BoneMaps) -> None:
    """Keep maps as a preset, which is JSON."""
    content = {
        "mocap_assist_bone_map": 1,
        "source": dict(maps.source.joints),
        "target": dict(maps.target.joints),
    }
    with written_whole(path) as part:
        part.write_text(json.dumps(content, indent=1, ensure_ascii=False), encoding="utf-8")


def read_maps(path: Path) -> BoneMaps:
    """Read a preset. Raises InvalidFileError where it is none."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        found = [
            HumanoidMap({str(role): str(bone) for role, bone in content[side].items()})
            for side in ("source", "target")
        ]
    except OSError as error:
        raise InvalidFileError(f"{path} cannot be read: {error.strerror}.") from error
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise InvalidFileError(f"{path} is no preset of bones, or is damaged.") from error
    return BoneMaps(*found)


def is_finger(role: str) -> bool:
    """Tell whether a role is a part of a finger."""
    return any(part in role for part in ("Thumb", "Index", "Middle", "Ring", "Little"))
