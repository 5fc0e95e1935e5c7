"""Button: learn from clean examples how bodies move, once, for many takes."""

from collections.abc import Callable

import bpy

from ..mocap_assist.learning import LearnSettings, read_learning, write_learned
from ..mocap_assist.selection import selected_armature
from ..mocap_assist.settings_properties import settings_from
from ..mocap_assist.solver_operator import SolverOperator
from ..solvers.denoising import FilterBases


@settings_from(LearnSettings)
class MOCAP_OT_learn_patterns(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.learn_patterns"
    bl_label = "Learn"
    bl_description = (
        "Learn from the examples how this kind of motion goes, and write it to a file that"
        " Clean can use for many takes"
    )
    bl_options = {"REGISTER"}  # it writes a file, and nothing that could be undone
    settings_group = "clean"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if selected_armature(context) is None:
            cls.poll_message_set("Select an armature that has the bones of the examples")
            return False
        return True

    def read(self, context: bpy.types.Context) -> Callable[..., FilterBases]:
        return read_learning(context.scene, selected_armature(context), self.settings())

    def write(self, context: bpy.types.Context, result: FilterBases) -> str:
        return write_learned(self.settings(), result)
