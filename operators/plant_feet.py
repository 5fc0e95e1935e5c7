"""Button: keep standing feet from sliding."""

from collections.abc import Callable

import bpy

from ..mocap_assist.jobs.planting import Replanted
from ..mocap_assist.planting import FeetSettings, read_planting, write_planted
from ..mocap_assist.selection import selected_armature, why_not_clean
from ..mocap_assist.settings_properties import settings_from
from ..mocap_assist.solver_operator import SolverOperator


@settings_from(FeetSettings)
class MOCAP_OT_plant_feet(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.plant_feet"
    bl_label = "Plant Feet"
    bl_description = (
        "Keep standing feet from sliding, where contacts are keyed on the armature, or else"
        " where they are detected. The result is a new action"
    )
    settings_group = "clean"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_clean(context):
            cls.poll_message_set(reason)
        return not reason

    def read(self, context: bpy.types.Context) -> Callable[..., Replanted]:
        return read_planting(context.scene, selected_armature(context), self.settings())

    def write(self, context: bpy.types.Context, result: Replanted) -> str:
        armature = selected_armature(context)
        return write_planted(context.scene, armature, self.settings(), result)
