"""The list of variants: which is played, and which are picked."""

from collections.abc import Sequence

import bpy

from ...solvers.errors import InvalidMotionError
from ..actions.armature_write import check_writable
from ..actions.fitting import fitting_slots
from ..blender import compat
from ..blender.compat import Source


def list_variants(
    scene: bpy.types.Scene,
    armature: bpy.types.Object | None,
    actions: Sequence[bpy.types.Action],
) -> None:
    """List new variants; the armature, if there is one, plays the first."""
    variants = scene.mocap_assist.variants
    variants.rows.clear()
    variants.armature = armature
    for action in actions:
        row = variants.rows.add()
        row.name, row.action = action.name, action
    variants.active = 0


def armature_of(scene: bpy.types.Scene) -> bpy.types.Object | None:
    """Return the armature that the variants were made for, if it is still in the scene."""
    armature = scene.mocap_assist.variants.armature
    there = armature is not None and scene.objects.get(armature.name) == armature
    return armature if there else None


def play_active(variants: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Let the armature play the variant that was clicked on, if both are still there."""
    armature = variants.armature
    if armature is None or not 0 <= variants.active < len(variants.rows):
        return
    action = variants.rows[variants.active].action
    slots = fitting_slots(armature, action) if action is not None else []
    try:
        check_writable(armature)
    except InvalidMotionError:
        return
    if slots:
        compat.assign(armature, action, slots[0])


def chosen_variants(scene: bpy.types.Scene) -> list[bpy.types.Action]:
    """Return the variants that are picked; all if none is."""
    rows = [row for row in scene.mocap_assist.variants.rows if row.action is not None]
    return [row.action for row in rows if row.picked] or [row.action for row in rows]


def why_none(context: bpy.types.Context) -> str:
    """Return why no variants are listed, or an empty text."""
    if not chosen_variants(context.scene):
        return "There are no variants yet. Press Vary."
    return ""


def why_not_keep(context: bpy.types.Context) -> str:
    """Return why no variants can be deleted, or an empty text."""
    if reason := why_none(context):
        return reason
    if not any(row.picked for row in context.scene.mocap_assist.variants.rows):
        return "Pick variants first."
    return ""


def keep_picked(scene: bpy.types.Scene) -> str:
    """Delete the variants that are not picked; return a sentence.

    Variants with other users, and assets, are kept; they only leave the list.
    """
    variants = scene.mocap_assist.variants
    kept = chosen_variants(scene)
    others = [row.action for row in variants.rows if row.action not in {None, *kept}]
    list_variants(scene, variants.armature, kept)
    spared = [action for action in others if is_used(action)]
    for action in others:
        if action not in spared:
            bpy.data.actions.remove(action)
    stay = f" {len(spared)} in use remain in the file." if spared else ""
    return f"{len(kept)} kept, {len(others) - len(spared)} deleted.{stay}"


def is_used(action: bpy.types.Action) -> bool:
    """Whether anything but our own list and the fake user holds an action."""
    if action.asset_data is not None:
        return True
    return any(not isinstance(user, bpy.types.Scene) for user in _users(action))


def _users(action: bpy.types.Action) -> set[bpy.types.ID]:
    return set(bpy.data.user_map(subset=[action])[action])


def source_for(armature: bpy.types.Object, action: bpy.types.Action) -> Source:
    """Return the action and its slot for an armature; raise InvalidMotionError if none fits."""
    slots = fitting_slots(armature, action)
    if not slots:
        raise InvalidMotionError(
            f"{armature.name} lacks the bones of {action.name}. Retarget the variants to it."
        )
    return action, slots[0]
