"""List of clean actions and recordings to learn from, and operators to fill it."""

from pathlib import Path
from typing import Any, ClassVar

import bpy

from ...solvers.recordings import SCENE_SUFFIXES
from ..blender.name_lists import CHANGES_A_LIST, SEPARATOR, join_names, split_names
from ..blender.path_properties import (
    HIDDEN,
    ChoosesFiles,
    ChoosesFolder,
    absolute,
    chosen_files,
)
from ..runtime.selection import selected_armature
from ..scene import history

ADD, ADD_FILES = "mocap_assist.add_example", "mocap_assist.add_example_files"
ADD_FOLDER = "mocap_assist.add_example_folder"
REMOVE_OPERATOR = "mocap_assist.remove_example"
CLEAN, RECONSTRUCT = "clean", "reconstruct"
"""Whose list it is: a property of `scene.mocap_assist`."""
RECORDINGS = ";".join(
    f"*{suffix}"
    for suffix in (".bvh", ".amc", ".c3d", ".trc", ".blend", *sorted(SCENE_SUFFIXES))
)
MAX_MENU_ENTRIES = 30


def draw_examples(
    layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup, group: str = CLEAN
) -> None:
    """Draw the examples, each with a button that takes it out."""
    for index, name in enumerate(split_names(settings.examples)):
        row = layout.row(align=True)
        action = name in bpy.data.actions
        shown = name if action else Path(name).name
        icon = "ACTION" if action else "FILE" if Path(name).suffix else "FILE_FOLDER"
        row.label(text=shown, icon=icon, translate=False)
        button = row.operator(REMOVE_OPERATOR, text="", icon="X", emboss=False)
        button.index, button.group = index, group
    layout.menu(MENUS[group], icon="ADD")


def candidate_actions(context: bpy.types.Context, group: str = CLEAN) -> list[str]:
    """Return the actions that may serve: recordings and clean ones, but not the one played."""
    armature = selected_armature(context)
    animation = armature.animation_data if armature is not None else None
    played = animation.action if animation is not None else None
    taken = _examples(context, group)
    return [
        action.name
        for action in bpy.data.actions
        if action not in {played, played and played.get(history.SOURCE)}
        and action.name not in taken
        and SEPARATOR not in action.name
    ]


class MOCAP_MT_examples(bpy.types.Menu):
    """Actions of this file, and recordings on disk."""

    bl_label = "Add Example"

    def draw(self, context: bpy.types.Context) -> None:
        _draw_menu(self.layout, context, CLEAN)


class MOCAP_MT_posture_examples(bpy.types.Menu):
    """Examples for the pose library."""

    bl_label = "Add Clip"

    def draw(self, context: bpy.types.Context) -> None:
        _draw_menu(self.layout, context, RECONSTRUCT)


def _draw_menu(layout: bpy.types.UILayout, context: bpy.types.Context, group: str) -> None:
    for name in candidate_actions(context, group)[:MAX_MENU_ENTRIES]:
        button = layout.operator(ADD, text=name, translate=False, icon="ACTION")
        button.example, button.group = name, group
    layout.separator()
    layout.operator(ADD_FILES, icon="FILE_FOLDER").group = group
    layout.operator(ADD_FOLDER, icon="FILE_FOLDER").group = group


MENUS = {CLEAN: "MOCAP_MT_examples", RECONSTRUCT: "MOCAP_MT_posture_examples"}


def _examples(context: bpy.types.Context, group: str) -> list[str]:
    return split_names(getattr(context.scene.mocap_assist, group).examples)


def _set_examples(context: bpy.types.Context, group: str, entries: list[str]) -> set[str]:
    getattr(context.scene.mocap_assist, group).examples = join_names(entries)
    return {"FINISHED"}


def _group() -> Any:
    """Return a property that selects the list."""
    return bpy.props.StringProperty(default=CLEAN, options={"HIDDEN", "SKIP_SAVE"})


class MOCAP_OT_add_example(bpy.types.Operator):
    bl_idname = ADD
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Add Action"
    bl_description = "Also learn from this clean action; it may have a different rig"

    example: bpy.props.StringProperty(
        name="Action", description="Name of the action", options={"SKIP_SAVE"}
    )
    group: _group()

    def execute(self, context: bpy.types.Context) -> set[str]:
        return _set_examples(
            context, self.group, [*_examples(context, self.group), self.example]
        )


class MOCAP_OT_remove_example(bpy.types.Operator):
    bl_idname = REMOVE_OPERATOR
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Remove Example"
    bl_description = "Remove this example from the list"

    index: bpy.props.IntProperty(
        name="Example", description="Index in the list", min=0, options={"SKIP_SAVE"}
    )
    group: _group()

    def execute(self, context: bpy.types.Context) -> set[str]:
        entries = enumerate(_examples(context, self.group))
        kept = [name for index, name in entries if index != self.index]
        return _set_examples(context, self.group, kept)


class MOCAP_OT_add_example_files(ChoosesFiles, bpy.types.Operator):
    bl_idname = ADD_FILES
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Recordings or .blend Files..."
    bl_description = (
        "Add clean recordings, or all actions of .blend files that contain their rig"
    )

    filter_glob: bpy.props.StringProperty(default=RECORDINGS, options=HIDDEN)
    group: _group()

    def execute(self, context: bpy.types.Context) -> set[str]:
        chosen = map(str, chosen_files(self))
        return _set_examples(context, self.group, [*_examples(context, self.group), *chosen])


class MOCAP_OT_add_example_folder(ChoosesFolder, bpy.types.Operator):
    bl_idname = ADD_FOLDER
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Folder on Disk..."
    bl_description = "Add all clean recordings in a folder, of any rig"

    group: _group()

    def execute(self, context: bpy.types.Context) -> set[str]:
        folder = str(absolute(self.directory))
        return _set_examples(context, self.group, [*_examples(context, self.group), folder])


register, unregister = bpy.utils.register_classes_factory((
    MOCAP_MT_examples,
    MOCAP_MT_posture_examples,
    MOCAP_OT_add_example,
    MOCAP_OT_remove_example,
    MOCAP_OT_add_example_files,
    MOCAP_OT_add_example_folder,
))
