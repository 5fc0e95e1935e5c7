"""Button: list what is wrong with the action that the active armature plays."""

from collections.abc import Callable

import bpy

from ..mocap_assist.check_choices import CheckSettings
from ..mocap_assist.checking import read_checking, show_checked
from ..mocap_assist.jobs.checking import Checked
from ..mocap_assist.selection import selected_armature, why_not_read
from ..mocap_assist.settings_properties import settings_from
from ..mocap_assist.solver_operator import SolverOperator


@settings_from(CheckSettings)
class MOCAP_OT_measure_quality(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.measure_quality"
    bl_label = "Check"
    bl_description = (
        "List where the armature's action jumps, shakes, has gaps, or lets feet slide"
    )
    settings_group = "check"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_read(context):
            cls.poll_message_set(reason)
        return not reason

    def read(self, context: bpy.types.Context) -> Callable[..., Checked]:
        return read_checking(context.scene, selected_armature(context), self.settings())

    def write(self, context: bpy.types.Context, result: Checked) -> str:
        return show_checked(context.scene, selected_armature(context), result)
