"""Button: the best matches are what Vary makes variants of."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.find_similar.varying import read_best, why_not_use, write_best
from ..mocap_assist.library.button_settings import UseBundle
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(UseBundle)
class MOCAP_OT_use_matches(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.use_matches"
    bl_label = "Use as Examples"
    bl_description = (
        "Use the best of these clips as examples of Vary, as actions of the selected armature"
    )
    settings_group = "use"
    why_not, read_scene, write_scene = why_not_use, read_best, write_best
