"""Button: show the recorded action while a key is held."""

import bpy

from ..mocap_assist.check.held_operator import HeldOperator


class MOCAP_OT_show_raw(HeldOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.show_raw"
    bl_label = "Show Raw While Held"
    bl_description = "Play the recorded action until the key is released, to compare"
