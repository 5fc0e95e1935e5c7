"""Button: thin out the keys of the active armature's action."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.retarget.button_settings import UnbakeBundle
from ..mocap_assist.retarget.scene_unbaking import read_unbaking, write_unbaked
from ..mocap_assist.runtime.selection import why_not_change
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(UnbakeBundle)
class MOCAP_OT_reduce_keys(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.reduce_keys"
    bl_label = "Unbake"
    bl_description = (
        "Replace a key on every frame with a few keys with handles; writes a new action"
    )
    settings_group = "unbake"
    why_not, read_scene, write_scene = why_not_change, read_unbaking, write_unbaked
