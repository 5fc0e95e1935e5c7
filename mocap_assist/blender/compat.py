"""Differences between Blender 4.5 and 5.x, and helpers for the action model.

One function per difference; the oldest branch comes first, to be deleted first.
"""

from typing import Any

import bpy

Source = tuple[bpy.types.Action, bpy.types.ActionSlot]
"""An action, and its slot that animates the object."""
TARGETS = {"OBJECT", "UNSPECIFIED"}  # the second comes from files of Blender 4.3 and older


def is_selected(bone: bpy.types.PoseBone) -> bool:
    """Whether a pose bone is selected; Blender 5.0 moved the flag to the pose."""
    return bool((bone.bone if bpy.app.version < (5, 0) else bone).select)


def select_bone(bone: bpy.types.PoseBone, selected: bool = True) -> None:
    """Select or deselect a pose bone."""
    if bpy.app.version < (5, 0):
        bone.bone.select = selected
    else:
        bone.select = selected


def is_hidden(bone: bpy.types.PoseBone) -> bool:
    """Whether a bone is not drawn; Blender 5.0 moved the flag to the pose."""
    collections = bone.bone.collections
    is_in_view = not collections or any(each.is_visible_effectively for each in collections)
    return bool((bone.bone if bpy.app.version < (5, 0) else bone).hide) or not is_in_view


def stored_properties(group: bpy.types.PropertyGroup) -> Any:
    """Return what a file holds for a group, by name; Blender 5.0 moved it out of the group."""
    return group if bpy.app.version < (5, 0) else group.bl_system_properties_get()


def find_slot(action: bpy.types.Action, identifier: str) -> bpy.types.ActionSlot | None:
    """Return the slot of that identifier, or the only one that can animate an object."""
    fitting = [slot for slot in action.slots if slot.target_id_type in TARGETS]
    named = [slot for slot in fitting if slot.identifier == identifier]
    return named[0] if named else fitting[0] if len(fitting) == 1 else None


def channelbag(
    action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> bpy.types.ActionChannelbag | None:
    """Return the channelbag of a slot; None if it has none."""
    bags = (strip.channelbag(slot) for layer in action.layers for strip in layer.strips)
    return next((bag for bag in bags if bag is not None), None)


def ensure_channelbag(
    action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> bpy.types.ActionChannelbag:
    """Return what holds the F-Curves of one slot; add it where there is none."""
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)


def assign(
    animated: bpy.types.ID, action: bpy.types.Action, slot: bpy.types.ActionSlot
) -> None:
    """Assign an action and its slot; without a slot an action animates nothing."""
    animation = animated.animation_data or animated.animation_data_create()
    animation.action = action
    animation.action_slot = slot


def new_action(name: str, animated: bpy.types.ID) -> Source:
    """Create an action with an empty channelbag and a fake user for `animated`."""
    action = bpy.data.actions.new(name)
    action.use_fake_user = True
    slot = action.slots.new(animated.id_type, animated.name)
    ensure_channelbag(action, slot)
    return action, slot


def new_curve(
    bag: bpy.types.ActionChannelbag, data_path: str, index: int, group: str
) -> bpy.types.FCurve:
    """Add an F-Curve to a channelbag, in the group of that name."""
    curve = bag.fcurves.new(data_path, index=index)
    curve.group = bag.groups.get(group) or bag.groups.new(group)
    return curve
