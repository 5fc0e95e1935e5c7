"""Button: keep standing feet from sliding."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.clean.scene_planting import FeetBundle, read_planting, write_planted
from ..mocap_assist.runtime.selection import why_not_change
from ..mocap_assist.runtime.solver_operator import SolverOperator


@settings_from(FeetBundle)
class MOCAP_OT_plant_feet(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.plant_feet"
    bl_label = "Plant Feet"
    bl_description = (
        "Keep planted feet from sliding, at keyed or detected contacts; writes a new action"
    )
    settings_group = "clean"
    why_not, read_scene, write_scene = why_not_change, read_planting, write_planted
