"""Button: add a workspace for motion capture."""

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.ui.workspace import add_workspace, why_no_workspace


class MOCAP_OT_add_workspace(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.add_workspace"
    bl_label = "Add Mocap Workspace"
    bl_description = "Add a workspace with 3D View, Graph Editor, Dope Sheet and Asset Browser"
    bl_options = {"REGISTER"}  # Blender's own undo does not know workspaces.
    why_not = why_no_workspace

    def act(self, context: bpy.types.Context) -> str:
        return add_workspace(context)
