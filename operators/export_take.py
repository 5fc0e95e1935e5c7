"""Button: write what an armature plays to a file of another program."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.exporting.button_settings import ExportBundle
from ..mocap_assist.exporting.file_browser import ExportOperator
from ..mocap_assist.exporting.scene_exporting import read_export, why_not_export, write_exported
from ..mocap_assist.runtime.selection import selected_armature


@settings_from(ExportBundle)
class MOCAP_OT_export_take(ExportOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.export_take"
    bl_label = "Export Clean Take"
    bl_description = (
        "Write the current action of the armature as FBX, GLB or BVH, at the scene's rate"
    )
    bl_options: ClassVar = {"REGISTER"}  # it writes a file, and nothing that could be undone
    settings_group = "export"
    selected = selected_armature
    why_not, read_scene, write_scene = why_not_export, read_export, write_exported
