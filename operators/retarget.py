"""Button: let another armature make the motion of the active one."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.retarget.button_settings import RetargetBundle
from ..mocap_assist.retarget.scene_retargeting import read_retarget, write_retargeted
from ..mocap_assist.runtime.selection import why_not_retarget
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(RetargetBundle)
class MOCAP_OT_retarget(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.retarget"
    bl_label = "Retarget"
    bl_description = (
        "Transfer this motion to another armature, regardless of size, rest pose and bone names"
    )
    settings_group = "retarget"
    why_not, read_scene, write_scene = why_not_retarget, read_retarget, write_retargeted
