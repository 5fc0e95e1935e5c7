"""Button: bring recordings of motion into the scene."""

from typing import ClassVar

import bpy
from bpy.props import StringProperty

from ..mocap_assist.blender.path_properties import HIDDEN
from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.importing.button_settings import ImportBundle
from ..mocap_assist.importing.dialog.file_kinds import kinds_of
from ..mocap_assist.importing.dialog.operators import (
    DIALOG_WIDTH_PX,
    FilesOperator,
    propose_start,
)
from ..mocap_assist.importing.importing import FILTER, chosen_paths, preview
from ..mocap_assist.runtime.solver_operator import in_background


@settings_from(ImportBundle)
class MOCAP_OT_import_recording(FilesOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.import_recording"
    bl_label = "Import Motion Capture"
    bl_description = (
        "Import motion capture files: BVH, AMC, C3D, TRC, depth camera joints and images"
    )
    # Undo is a step of the operator that waits: the file browser would add an empty one.
    bl_options: ClassVar = {"REGISTER", "PRESET"}

    filter_glob: StringProperty(default=FILTER, options=HIDDEN)
    _was_invoked = False

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not self._was_invoked or in_background():
            return super().execute(context)
        # Blender frees an operator that the file browser has executed, so another one waits.
        bpy.ops.mocap_assist.import_job("INVOKE_DEFAULT", **self.given())
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        self._was_invoked = True
        propose_start(self, context)
        if not chosen_paths(self):
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        paths = chosen_paths(self)
        self.note, self.kinds = preview(context, paths), kinds_of(paths)
        self.note_width = DIALOG_WIDTH_PX
        status: set[str] = context.window_manager.invoke_props_dialog(
            self, width=DIALOG_WIDTH_PX, confirm_text="Import"
        )
        return status
