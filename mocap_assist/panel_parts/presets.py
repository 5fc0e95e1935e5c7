"""Presets in the headers of panels: those of Mocap Assist, and the animator's own.

Shipped presets are values in `solvers/presets.py`. Blender writes the animator's own ones into
the user's folder of presets and runs them from there, and from nowhere else: a .blend holds
none.
"""

from typing import Any, ClassVar

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ...solvers.presets import PRESETS, mentioned_settings
from ...solvers.settings import Choice, in_title_case
from ..languages import translated

USE_OPERATOR = "mocap_assist.use_preset"
VERBS = {"clean": "denoise"} | {each: each for each in PRESETS if each != "denoise"}
"""Verb of each group of settings, `scene.mocap_assist.<group>`, that has presets."""


class MOCAP_OT_use_preset(bpy.types.Operator):
    bl_idname = USE_OPERATOR
    bl_label = "Use Preset"
    bl_description = "Give some settings of this panel the values of a preset"
    bl_options: ClassVar = {"INTERNAL", "UNDO"}

    group: bpy.props.StringProperty(name="Panel", options={"HIDDEN", "SKIP_SAVE"})
    preset: bpy.props.StringProperty(name="Preset", options={"HIDDEN", "SKIP_SAVE"})

    @classmethod
    def description(cls, context: bpy.types.Context, properties: Any) -> str:
        return translated(PRESETS[VERBS[properties.group]][properties.preset].help)

    def execute(self, context: bpy.types.Context) -> set[str]:
        use_preset(context.scene, self.group, self.preset)
        return {"FINISHED"}


def use_preset(scene: bpy.types.Scene, group: str, name: str) -> None:
    """Give settings of a panel the values of a shipped preset, or else their defaults."""
    verb, shown = VERBS[group], getattr(scene.mocap_assist, group)
    values = PRESETS[verb][name].values
    for setting in mentioned_settings(verb):
        if setting not in values:
            shown.property_unset(setting)
        else:
            setattr(shown, setting, _property_value(shown, setting, values[setting]))


def _property_value(shown: bpy.types.PropertyGroup, setting: str, value: Any) -> Any:
    """Return a value as Blender's property has it: a choice by the name of its member."""
    present = next(
        getattr(each, setting) for each in shown.settings() if hasattr(each, setting)
    )
    kind: Any = type(present)
    return kind(value).name if isinstance(present, Choice) else value


def draw_presets(layout: bpy.types.UILayout, group: str) -> None:
    """Draw the icon that opens the presets of a panel, for its header."""
    MENUS[group].draw_panel_header(layout)


class PresetMenu(PresetPanel):
    """The shipped presets, then the animator's own, with fields to add and remove them."""

    group: ClassVar[str]
    preset_subdir: ClassVar[str]
    preset_add_operator: ClassVar[str]

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.emboss = "PULLDOWN_MENU"
        for name in PRESETS[VERBS[self.group]]:
            button = layout.operator(USE_OPERATOR, text=name)
            button.group, button.preset = self.group, name
        layout.separator()
        if bpy.utils.preset_paths(self.preset_subdir):
            PresetPanel.draw(self, context)
        else:
            self._draw_first(context)

    def _draw_first(self, context: bpy.types.Context) -> None:
        """Draw the fields for the first own preset; Blender would report a missing folder."""
        manager = context.window_manager
        row = self.layout.row()
        field = row.row()
        field.emboss = "NORMAL"
        field.prop(manager, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = manager.preset_name


class OwnPreset(AddPresetBase):
    """Save the settings of a panel as the animator's own preset, or remove it."""

    group: ClassVar[str]

    @property
    def preset_values(self) -> list[str]:
        """Return the settings to save: not texts, which name things of this file."""
        shown = getattr(bpy.context.scene.mocap_assist, self.group)
        properties = shown.bl_rna.properties
        return [
            f"settings.{name}"
            for name in type(shown).setting_names
            if properties[name].type != "STRING"
        ]


def _menu(group: str) -> type[bpy.types.Panel]:
    own = {
        "group": group,
        "preset_subdir": f"mocap_assist/{group}",
        "preset_operator": "script.execute_preset",
        "preset_add_operator": f"mocap_assist.{group}_preset_add",
    }
    return type(f"MOCAP_PT_{group}_presets", (PresetMenu, bpy.types.Panel), own)


def _preset_operator(group: str) -> type[bpy.types.Operator]:
    own = {
        "group": group,
        "bl_idname": f"mocap_assist.{group}_preset_add",
        "bl_label": f"Add {in_title_case(group)} Preset",
        "bl_description": "Save these settings as a preset of your own, or remove it",
        "preset_menu": f"MOCAP_PT_{group}_presets",
        "preset_subdir": f"mocap_assist/{group}",
        "preset_defines": [f"settings = bpy.context.scene.mocap_assist.{group}"],
    }
    return type(f"MOCAP_OT_{group}_preset_add", (OwnPreset, bpy.types.Operator), own)


MENUS = {group: _menu(group) for group in VERBS}
register, unregister = bpy.utils.register_classes_factory((
    MOCAP_OT_use_preset,
    *MENUS.values(),
    *map(_preset_operator, VERBS),
))
