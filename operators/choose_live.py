"""Button: choose the recording that Track Live follows, in an empty scene."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.act_operator import ActOperator
from ..mocap_assist.blender.path_properties import HIDDEN, ChoosesFolder
from ..mocap_assist.track.follow_panel import choose_recording


class MOCAP_OT_choose_live(ChoosesFolder, ActOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.choose_live"
    bl_label = "Choose Live Recording"
    bl_description = (
        "Choose the folder of depth images, or the .mkv, that a recorder writes, for Track Live"
    )
    bl_options: ClassVar = {"REGISTER", "UNDO"}

    filename: bpy.props.StringProperty(options=HIDDEN)
    filter_glob: bpy.props.StringProperty(default="*.png;*.mkv", options=HIDDEN)

    def act(self, context: bpy.types.Context) -> str:
        return choose_recording(context.scene, self.directory, self.filename)
