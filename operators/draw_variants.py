"""Button: draw a contact sheet of all variants."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.blender.path_properties import file_to_write, path_property
from ..mocap_assist.languages import translated
from ..mocap_assist.variants.crowd import why_not_stack
from ..mocap_assist.variants.sheet import write_sheet
from ..solvers.errors import MocapAssistError

PNG = ".png"


class MOCAP_OT_draw_variants(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.draw_variants"
    bl_label = "Contact Sheet"
    bl_description = "Draw the picked variants, or all, as stick figures to a PNG file"
    bl_options: ClassVar = {"REGISTER"}
    why_not = why_not_stack

    filepath: path_property(options={"SKIP_SAVE"}, name="File", description="PNG file to write")
    filter_glob: bpy.props.StringProperty(default=f"*{PNG}", options={"HIDDEN", "SKIP_SAVE"})
    check_existing: bpy.props.BoolProperty(default=True, options={"HIDDEN", "SKIP_SAVE"})

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if not self.filepath:
            self.filepath = bpy.path.abspath(f"//variants{PNG}")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            path = file_to_write(self.filepath, PNG)
            self.report({"INFO"}, translated(write_sheet(context.scene, path)))
        except (MocapAssistError, OSError) as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        return {"FINISHED"}
