"""Button: make the skeleton that the markers of an optical take sit on."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.markers.scene_skeleton import (
    SolveBundle,
    read_solving,
    why_not_solve,
    write_solved,
)
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(SolveBundle)
class MOCAP_OT_solve_skeleton(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.solve_skeleton"
    bl_label = "Make Skeleton"
    bl_description = "Solve an armature from Plug-in-Gait or CMU markers; the markers are kept"
    settings_group = "solve"
    why_not, read_scene, write_scene = why_not_solve, read_solving, write_solved
