"""Rows with a tick for each action that a button works on."""

from collections.abc import Sequence
from typing import ClassVar

import bpy

from ..blender.name_lists import SEPARATOR, join_names, split_names
from ..languages import translated

TICK = "mocap_assist.tick_action"
MAX_LISTED = 30


def draw_ticks(
    layout: bpy.types.UILayout,
    context: bpy.types.Context,
    actions: Sequence[bpy.types.Action],
    group: str,
) -> None:
    """Draw the actions that fit, and what is ticked but does not, such as a former name."""
    settings = getattr(context.scene.mocap_assist, group)
    ticked = split_names(settings.actions)
    names = [action.name for action in actions[:MAX_LISTED]]
    box = layout.column(align=True)
    for name in dict.fromkeys([*names, *ticked]):
        icon = "CHECKBOX_HLT" if name in ticked else "CHECKBOX_DEHLT"
        button = box.operator(TICK, text=name, translate=False, icon=icon)
        button.action, button.group = name, group
    if len(actions) > MAX_LISTED:
        layout.prop(settings, "actions")


class MOCAP_OT_tick_action(bpy.types.Operator):
    bl_idname = TICK
    bl_label = "Select Action"
    bl_description = "Add this action to the selection, or remove it"
    bl_options: ClassVar = {"INTERNAL", "UNDO"}

    action: bpy.props.StringProperty(
        name="Action", description="Name of the action", options={"SKIP_SAVE"}
    )
    group: bpy.props.StringProperty(default="retarget", options={"HIDDEN", "SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        if SEPARATOR in self.action:
            self.report(
                {"ERROR"},
                translated(f"Rename {self.action}: a name cannot contain {SEPARATOR}."),
            )
            return {"CANCELLED"}
        shown = getattr(context.scene.mocap_assist, self.group)
        names = split_names(shown.actions)
        others = [name for name in names if name != self.action]
        shown.actions = join_names(
            others if len(others) < len(names) else [*names, self.action]
        )
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((MOCAP_OT_tick_action,))
