"""Button: give the clip that is chosen in the list to the armature."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.find_similar.loading import read_loading, why_not_load, write_loaded
from ..mocap_assist.library.button_settings import LoadBundle
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(LoadBundle)
class MOCAP_OT_load_match(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.load_match"
    bl_label = "Append as Action"
    bl_description = "Transfer the motion of this clip to the selected armature as a new action"
    settings_group = "load"
    why_not, read_scene, write_scene = why_not_load, read_loading, write_loaded
