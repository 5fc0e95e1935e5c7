"""The list of a library's sources, and operators to fill it."""

from pathlib import Path
from typing import ClassVar

import bpy

from ..blender.name_lists import CHANGES_A_LIST, split_names
from ..blender.path_properties import (
    HIDDEN,
    ChoosesFiles,
    ChoosesFolder,
    absolute,
    chosen_files,
)
from ..languages import translated
from .auto_update_list import change_sources
from .sources import asset_folders

ADD_FOLDER, ADD_FILES = "mocap_assist.add_source_folder", "mocap_assist.add_source_files"
REMOVE_OPERATOR = "mocap_assist.remove_source"
FILES = "*.bvh;*.amc;*.c3d;*.trc;*.skeleton;*.csv;*.json;*.txt;*.npy;*.npz;*.blend"


def draw_sources(layout: bpy.types.UILayout, library: bpy.types.PropertyGroup) -> None:
    """Draw the sources, each with a button to remove it."""
    column = layout.column(align=True)
    for index, name in enumerate(split_names(library.sources)):
        row = column.row(align=True)
        path = Path(name)
        icon = "FILE_BLEND" if path.suffix == ".blend" else "FILE"
        row.label(
            text=path.name or name, icon=icon if path.suffix else "FILE_FOLDER", translate=False
        )
        row.operator(REMOVE_OPERATOR, text="", icon="X", emboss=False).index = index
    row = column.row(align=True)
    row.operator(ADD_FOLDER, text="Folder", icon="ADD")
    row.operator(ADD_FILES, text="Files", icon="ADD")
    n_assets = len(asset_folders())
    if n_assets or library.asset_libraries:
        text = translated(f"{n_assets} asset libraries")
        column.prop(library, "asset_libraries", text=text, translate=False)


def _add(context: bpy.types.Context, chosen: list[str]) -> set[str]:
    library = context.scene.mocap_assist.library
    change_sources(library, [*split_names(library.sources), *chosen])
    return {"FINISHED"}


class MOCAP_OT_add_source_folder(ChoosesFolder, bpy.types.Operator):
    bl_idname = ADD_FOLDER
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Add Folder"
    bl_description = "Add a folder with all recordings and .blend files in it and below"

    def execute(self, context: bpy.types.Context) -> set[str]:
        return _add(context, [str(absolute(self.directory))])


class MOCAP_OT_add_source_files(ChoosesFiles, bpy.types.Operator):
    bl_idname = ADD_FILES
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Add Files"
    bl_description = "Add recordings, or .blend files with actions"

    filter_glob: bpy.props.StringProperty(default=FILES, options=HIDDEN)

    def execute(self, context: bpy.types.Context) -> set[str]:
        return _add(context, [str(path) for path in chosen_files(self)])


class MOCAP_OT_remove_source(bpy.types.Operator):
    bl_idname = REMOVE_OPERATOR
    bl_options: ClassVar = CHANGES_A_LIST
    bl_label = "Remove Source"
    bl_description = "Remove this source; its clips stay in the library"

    index: bpy.props.IntProperty(
        name="Source", description="Index in the list", min=0, options={"SKIP_SAVE"}
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        library = context.scene.mocap_assist.library
        entries = enumerate(split_names(library.sources))
        change_sources(library, [name for index, name in entries if index != self.index])
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((
    MOCAP_OT_add_source_folder,
    MOCAP_OT_add_source_files,
    MOCAP_OT_remove_source,
))
