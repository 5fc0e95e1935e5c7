"""Button: bring recordings of motion into the scene."""

from typing import ClassVar

import bpy
from bpy.props import CollectionProperty, StringProperty

from ..mocap_assist.import_choices import ImportSettings
from ..mocap_assist.importing import FILTER, chosen_paths, import_watched, preview
from ..mocap_assist.settings_properties import settings_from
from ..mocap_assist.ui.drawing import draw_lines

GIVEN = {"HIDDEN", "SKIP_SAVE"}
WIDTH = 400  # of the dialog, pixels at scale 1


@settings_from(ImportSettings)
class MOCAP_OT_import_recording(bpy.types.Operator):
    bl_idname = "mocap_assist.import_recording"
    bl_label = "Import Motion Capture"
    bl_description = (
        "Bring recordings of motion into the scene, many files at once: BVH, AMC, C3D, TRC, and"
        " joints of depth cameras. Joints become an armature, markers become empties"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO", "PRESET"}

    directory: StringProperty(subtype="DIR_PATH", options=GIVEN)
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options=GIVEN)
    filepath: StringProperty(subtype="FILE_PATH", options=GIVEN)
    note: StringProperty(options=GIVEN)
    filter_glob: StringProperty(default=FILTER, options=GIVEN)

    def execute(self, context: bpy.types.Context) -> set[str]:
        imported = import_watched(context, chosen_paths(self), self.settings().choices)
        self.note = imported.note
        self.report({"ERROR"} if imported.failed else {"INFO"}, imported.sentence)
        return {"FINISHED"} if imported.made else {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not chosen_paths(self):
            context.window_manager.fileselect_add(self)
            return {"RUNNING_MODAL"}
        self.note = preview(context, chosen_paths(self))
        return context.window_manager.invoke_props_dialog(self, width=WIDTH)

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in type(self).setting_names:
            self.layout.prop(self, name)
        if self.note:
            draw_lines(self.layout, self.note, WIDTH)
