"""Button: write the issues that Check found as timeline markers, or remove those."""

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.check.issue_markers import mark_issues, remove_issue_markers, why_not_mark


class MOCAP_OT_mark_issues(ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.mark_issues"
    bl_label = "Issues to Markers"
    bl_description = "Write a timeline marker at each listed issue, or remove those markers"
    bl_options = {"REGISTER", "UNDO"}
    why_not = why_not_mark

    remove: bpy.props.BoolProperty(
        name="Remove",
        description="Only remove the markers of issues",
        options={"SKIP_SAVE"},
    )

    def act(self, context: bpy.types.Context) -> str:
        return remove_issue_markers(context.scene) if self.remove else mark_issues(context)
