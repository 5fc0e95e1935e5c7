"""Button: bring the built-in sample take into the scene."""

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.importing.sample_take import load_sample_take, why_not_load


class MOCAP_OT_load_sample(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.load_sample"
    bl_label = "Load Sample Take"
    bl_description = "Add a walk with the typical faults of motion capture, to try the buttons"
    bl_options = {"REGISTER", "UNDO"}
    why_not = why_not_load

    def act(self, context: bpy.types.Context) -> str:
        return load_sample_take(context)
