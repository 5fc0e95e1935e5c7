"""Button: learn from clean examples how bodies move, once, for many takes."""

from typing import ClassVar

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.clean.scene_learning import LearnBundle, read_learning, write_learned
from ..mocap_assist.runtime.selection import why_not_learn
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(LearnBundle)
class MOCAP_OT_learn_patterns(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.learn_patterns"
    bl_label = "Learn"
    bl_description = (
        "Learn a motion model from the examples and write it to a file for many takes"
    )
    bl_options: ClassVar = {"REGISTER"}  # it writes a file, and nothing that could be undone
    settings_group = "clean"
    why_not, read_scene, write_scene = why_not_learn, read_learning, write_learned
