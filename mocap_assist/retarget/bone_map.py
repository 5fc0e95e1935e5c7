"""Roles of the bones of source and target: found, edited, or from presets."""

from collections.abc import Callable
from typing import NamedTuple

import bpy

from ...solvers.motion import HUMANOID_ROLES, HumanoidMap, read_humanoid_map
from ...solvers.motion.humanoid import ESSENTIAL_ROLES, MIN_CONFIDENCE
from ..blender.path_properties import absolute
from ..rigs.role_confidence import explain_rig_roles
from ..rigs.target_read import find_roles

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
LISTED_ARMATURES = ("source", "target")
TAKEN = "another row has this bone, so this one is ignored"
MISSING = "the armature has no such bone"


class BoneMaps(NamedTuple):
    """Names of bones by role, of both armatures."""

    source: HumanoidMap
    target: HumanoidMap


def find_maps(source: bpy.types.Object, target: bpy.types.Object) -> BoneMaps:
    """Find the role of each bone by name and structure."""
    return BoneMaps(find_roles(source), find_roles(target))


def maps_for(
    scene: bpy.types.Scene,
    source: bpy.types.Object,
    target: bpy.types.Object,
    files: tuple[str, str] = ("", ""),
) -> BoneMaps:
    """Return the maps of presets, or of the list if it is of these armatures; or find them.

    Raises InvalidFileError for a preset that cannot be read.
    """
    listed = scene.mocap_assist.bone_map
    armatures = (source, target)
    known: tuple[HumanoidMap | None, ...] = (None, None)
    if (listed.source, listed.target) == (source.name, target.name) and len(listed.rows):
        known = listed_maps(listed)
    return BoneMaps(
        *(
            read_humanoid_map(absolute(file)) if file else map_ or find_roles(each)
            for each, file, map_ in zip(armatures, files, known, strict=True)
        )
    )


def listed_maps(listed: bpy.types.PropertyGroup) -> BoneMaps:
    """Return the humanoid map of the list; a bone that is named twice counts once."""
    maps = []
    for side in LISTED_ARMATURES:
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
    """Show maps in the list of bones, a row for each role; fingers only where there are any."""
    listed.source = listed.target = ""  # so that no row is explained before all are there
    listed.source_score, listed.target_score = (each.score for each in maps)
    listed.rows.clear()
    played = {role for each in maps for role in each.joints}
    for role in sorted(HUMANOID_ROLES, key=is_finger):
        if role in played or not is_finger(role):
            row = listed.rows.add()
            row.name = role
            row.source = maps.source.joint(role) or ""
            row.target = maps.target.joint(role) or ""
    listed.source, listed.target = source.name, target.name
    explain_rows(listed)


def explain_rows(listed: bpy.types.PropertyGroup) -> None:
    """Write confidence and reason into all rows, for the armatures of the list."""
    for side, humanoid in zip(LISTED_ARMATURES, listed_maps(listed), strict=True):
        armature = listed_armature(listed, side)
        if armature is None:
            continue
        evidence = explain_rig_roles(armature, humanoid)
        for row in listed.rows:
            found, bone = evidence.get(row.name), getattr(row, side)
            lack = TAKEN if bone in armature.data.bones else MISSING
            setattr(row, f"{side}_confidence", found.confidence if found else 0.0)
            setattr(row, f"{side}_reason", found.text if found else lack if bone else "")


def listed_armature(listed: bpy.types.PropertyGroup, side: str) -> bpy.types.Object | None:
    """Return the armature on one side of the list, if it is still in the scene."""
    armature = listed.id_data.objects.get(getattr(listed, side))
    return armature if armature is not None and armature.type == "ARMATURE" else None


def explain_edited(side: str) -> Callable[[bpy.types.PropertyGroup, bpy.types.Context], None]:
    """Return the callback for edits of a bone on this side.

    All rows are explained again, because the roles of a limb depend on each other, and the
    score follows.
    """

    def explain(row: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
        listed = row.id_data.mocap_assist.bone_map
        if listed.source and listed.target:
            explain_rows(listed)
            setattr(listed, f"{side}_score", fraction_of_certain_roles(listed, side))

    return explain


def fraction_of_certain_roles(listed: bpy.types.PropertyGroup, side: str) -> float:
    """Return the fraction of the essential roles whose bone has no low confidence."""
    certain = [
        row
        for row in listed.rows
        if row.name in ESSENTIAL_ROLES
        and getattr(row, side)
        and not has_low_confidence(row, side)
    ]
    return len(certain) / len(ESSENTIAL_ROLES)


def count_low_confidence(listed: bpy.types.PropertyGroup) -> int:
    """Return how many bones of the list have low confidence."""
    return sum(
        has_low_confidence(row, side) for row in listed.rows for side in LISTED_ARMATURES
    )


def has_low_confidence(row: bpy.types.PropertyGroup, side: str) -> bool:
    """Whether the bone on one side of a row has low confidence."""
    low: bool = getattr(row, f"{side}_confidence") < MIN_CONFIDENCE
    return bool(getattr(row, side)) and low


def is_finger(role: str) -> bool:
    """Return whether a role is a part of a finger."""
    return any(finger in role for finger in FINGERS)
