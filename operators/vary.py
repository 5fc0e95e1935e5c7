"""Button: many new motions of a few."""

import bpy

from ..mocap_assist.blender.settings_properties import settings_from
from ..mocap_assist.runtime.solver_operator import SolverOperator
from ..mocap_assist.variants.button_settings import VaryBundle
from ..mocap_assist.variants.reading import read_varying, why_not_vary
from ..mocap_assist.variants.writing import write_variants


@settings_from(VaryBundle)
class MOCAP_OT_vary(SolverOperator, bpy.types.Operator):
    bl_idname = "mocap_assist.vary"
    bl_label = "Vary"
    bl_description = (
        "Generate variations of one to ten similar actions; the same seed repeats them"
    )
    settings_group = "vary"
    why_not, read_scene, write_scene = why_not_vary, read_varying, write_variants
