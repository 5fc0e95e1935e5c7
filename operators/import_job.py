"""The second half of the button Import, once it is known which files, and how."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.importing.button_settings import ImportBundle
from ..mocap_assist.importing.dialog.operators import WaitingImport


@settings_from(ImportBundle)
class MOCAP_OT_import_job(WaitingImport, bpy.types.Operator):
    bl_idname = "mocap_assist.import_job"
    bl_label = "Import Motion Capture"
    bl_description = "Read files in a separate process and import them into the scene"
    bl_options: ClassVar = {"REGISTER", "UNDO", "INTERNAL"}
