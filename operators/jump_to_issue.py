"""Button: jump to an issue that Check found."""

import bpy

from ..mocap_assist.check.issue_views import show_issue
from ..mocap_assist.check.scene_checking import jump_to
from ..mocap_assist.languages import translated


class MOCAP_OT_jump_to_issue(bpy.types.Operator):
    bl_idname = "mocap_assist.jump_to_issue"
    bl_label = "Jump to Issue"
    bl_description = "Go to this frame and select the affected bone"
    bl_options = {"REGISTER", "UNDO"}

    # Without SKIP_SAVE, Blender would fill in the index of the press before.
    index: bpy.props.IntProperty(
        name="Issue",
        description="Index in the list; -1 for the selected issue",
        default=-1,
        options={"SKIP_SAVE"},
    )
    step: bpy.props.IntProperty(
        name="Step",
        description="Number of issues to move forward from the selected one",
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not context.scene.mocap_assist.issues:
            cls.poll_message_set(translated("No issues are listed. Press Check first"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        found = context.scene.mocap_assist
        index = found.active_issue + self.step if self.index < 0 else self.index
        found.active_issue = index % len(found.issues)
        jump_to(context, found.issues[found.active_issue])
        show_issue(context, found.issues[found.active_issue])
        return {"FINISHED"}
